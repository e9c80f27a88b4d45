#pragma once

#include <Eigen/Core>

namespace loopgrid {

/// The path on which Powell's dog leg (1970) looks for a step: from zero straight to the minimum
/// of the quadratic model along the steepest descent (the Cauchy point), from there straight to the
/// minimum of the model (the Gauss-Newton step). Along the path the distance from zero grows and
/// the model falls.
class DogLegPath {
 public:
  /// The length of v is the root of the sum of scale(i) * v(i)^2.
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

/// The radius for the next step, after a step of `length` within `radius`. `gain` is the decrease
/// of F divided by the decrease that the model promised; it is negative if the step was not taken.
double NextRadius(double radius, double length, double gain);

}  // namespace loopgrid
