#pragma once

#include <Eigen/Core>
#include <optional>

#include "backend/solve/descent.h"

namespace loopgrid {

/// Takes Gauss-Newton steps as long as they lower F, at once or within the next few steps. Where
/// they do not, it takes damped steps (Marquardt 1963).
template <typename Pose>
class LevenbergMarquardt : public StepMethod<Pose> {
 public:
  std::optional<Termination> MakeStep(Descent<Pose>* descent) override;
  double damping() const override { return damping_; }

 private:
  /// Tries the step by the present factor, unless it promises a larger decrease than a limit.
  Trial::Kind TryFactor(double most_promised, Descent<Pose>* descent);
  /// Takes some full steps although the first raises F. Returns to the start, and false, if they do
  /// not lower F in the end.
  bool LookAhead(const Eigen::VectorXd& first_step, Descent<Pose>* descent);
  /// The lambda that makes the last step about half as long: much less has hardly any effect.
  double NaturalDamping(const Linearization<Pose>& linearization) const;
  bool IsFactorTrusted(const Linearization<Pose>& linearization) const;
  void Strengthen();
  void Weaken();

  static constexpr double kFirst = 1e-5;  // the largest first lambda

  double damping_ = 0.0;           // lambda: multiplies Linearization::Scale
  double first_damping_ = kFirst;  // the first lambda above 0; a lower one becomes 0
  bool factor_fits_ = false;       // the factor is of the last point, and good enough for this one
  double moved_ = 0.0;  // the largest entries of the steps since the factor was made, summed
  double last_promised_ = 0.0;  // decrease of F, by the last step
  double last_gain_ = 0.0;      // decrease of F by the last step, divided by last_promised_
  Eigen::VectorXd last_step_;   // the last one that was tried, whether taken or not
  int failed_trials_ = 0;       // calls of LookAhead that failed since one succeeded
};

extern template class LevenbergMarquardt<SE2>;
extern template class LevenbergMarquardt<SE3>;

}  // namespace loopgrid
