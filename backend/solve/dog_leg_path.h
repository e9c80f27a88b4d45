#pragma once

#include <Eigen/Core>

namespace loopgrid {

/// The path on which Powell's dog leg (1970) looks for a step: from zero straight to the minimum
/// of the quadratic model along the steepest descent (the Cauchy point), from there straight to the
/// minimum of the model (the Gauss-Newton step). Along it lengths grow and the model falls.
class DogLegPath {
 public:
  /// Lengths are those of the vectors whose i-th coordinate is multiplied by the root of scale(i).
  DogLegPath(Eigen::VectorXd cauchy, Eigen::VectorXd newton, Eigen::VectorXd scale);

  /// The last point of the path that is not longer than `radius`.
  Eigen::VectorXd PointWithin(double radius) const;

  double Length(const Eigen::VectorXd& v) const;

 private:
  double Product(const Eigen::VectorXd& v, const Eigen::VectorXd& w) const;

  Eigen::VectorXd cauchy_;
  Eigen::VectorXd newton_;
  Eigen::VectorXd scale_;
};

/// The radius within which the model is trusted after a step of `length` within `radius` that has
/// lowered F by `gain` times what the model promised; negative gains are of steps not taken.
double NextRadius(double radius, double length, double gain);

}  // namespace loopgrid
