#pragma once

#include <Eigen/Core>
#include <optional>

#include "backend/solve/descent.h"

namespace loopgrid {

/// Gauss-Newton steps as long as they lower F, at once or within the next few steps; damped ones
/// (Marquardt 1963) where they do not.
template <typename Pose>
class LevenbergMarquardt : public StepMethod<Pose> {
 public:
  std::optional<Termination> MakeStep(Descent<Pose>* descent) override;
  double damping() const override { return damping_; }

 private:
  /// A step by the present factor, unless it promises more than a limit.
  Trial::Kind TryFactor(double most_promised, Descent<Pose>* descent);
  /// Full steps, the first of which raises F, if a few of them lower it in the end.
  bool LookAhead(const Eigen::VectorXd& first_step, Descent<Pose>* descent);
  /// The lambda at which the last step would come out about half as long: the first that matters.
  double NaturalDamping(const Linearization<Pose>& linearization) const;
  bool IsFactorTrusted(const Linearization<Pose>& linearization) const;
  void Strengthen();
  void Weaken();

  static constexpr double kFirst = 1e-5;  // unless the problem says better

  double damping_ = 0.0;           // lambda: multiplies Linearization::Scale
  double first_damping_ = kFirst;  // less than this is none
  bool factor_fits_ = false;       // the factor is of the last point, and good enough for this one
  double moved_ = 0.0;  // the largest entries of the steps since the factor was made, summed
  double last_promised_ = 0.0;  // decrease of F, by the last step
  double last_gain_ = 0.0;      // the share of that which came true
  Eigen::VectorXd last_step_;   // tried
  int failed_trials_ = 0;       // of looking ahead, in a row
};

extern template class LevenbergMarquardt<SE2>;
extern template class LevenbergMarquardt<SE3>;

}  // namespace loopgrid
