#include "backend/solve/levenberg_marquardt.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace loopgrid {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Lambda multiplies the Hessian's diagonal, so these have no unit.
constexpr double kLargestDamping = 1e10;
constexpr double kDampingFactor = 10.0;
constexpr double kOvershot = 0.25;  // share of the promised decrease

// If the decrease of F differs from what the model promised by less than the first share, the
// Hessian has hardly changed, and its factor is used for the next step, too (a chord step of
// Newton's method), as long as each step promises less than the second share of the one before.
constexpr double kGoodModel = 0.1;
constexpr double kSlow = 0.1;

// A step of length d (metres or radians) changes Jacobians by about d, and the smallest eigenvalue
// of a Hessian with the condition number k, relative to itself, by about 2 d sqrt(k) + d^2 k. This
// is d^2 k for a change by a tenth: as long as d^2 k is less, the old factor shows whether the
// point is a minimum.
constexpr double kSmallChange = 2.5e-3;

// After a full step that does not lower F, a trial takes up to kLookAhead full steps. After kTrials
// trials that failed in a row there are no more. A trial succeeds if it lowers F by the share
// kWorthwhile of what its first step promised. Without such a bound, steps could alternate between
// points of nearly the same F for ever.
constexpr int kLookAhead = 3;
constexpr int kTrials = 3;
constexpr double kWorthwhile = 0.1;
// A trial may take more steps as long as each multiplies F by less than this.
constexpr double kReturns = 0.1;

}  // namespace

template <typename Pose>
std::optional<Termination> LevenbergMarquardt<Pose>::MakeStep(Descent<Pose>* descent) {
  Linearization<Pose>& linearization = descent->linearization();
  if (factor_fits_) {
    const Trial::Kind trial = TryFactor(kSlow * last_promised_, descent);
    if (trial == Trial::Kind::kTaken) return std::nullopt;
    if (trial == Trial::Kind::kNegligible && IsFactorTrusted(linearization)) {
      return Termination::kConverged;
    }
  }
  bool has_factor = false;
  bool was_indefinite = false;
  bool was_rejected = false;
  while (damping_ <= kLargestDamping) {
    moved_ = 0.0;
    if (linearization.Factorize(damping_) == Definiteness::kIndefinite) {
      was_indefinite = true;
      Strengthen();
      continue;
    }
    has_factor = true;
    switch (TryFactor(kInfinity, descent)) {
      case Trial::Kind::kTaken:
        if (last_gain_ < kOvershot) {
          // The step went beyond the minimum along it, so the next ones should be shorter.
          if (damping_ == 0.0) first_damping_ = NaturalDamping(linearization);
          Strengthen();
        } else {
          Weaken();
        }
        return std::nullopt;
      case Trial::Kind::kNegligible:
        if (was_rejected) return Termination::kStalled;
        if (damping_ == 0.0) return Termination::kConverged;
        if (was_indefinite) return Termination::kIndefinite;
        Weaken();  // the step may be small only because the damping is strong
        break;
      case Trial::Kind::kRejected:
        if (damping_ == 0.0) {
          first_damping_ = NaturalDamping(linearization);
          if (LookAhead(last_step_, descent)) return std::nullopt;
        }
        Strengthen();
        was_rejected = true;
    }
  }
  return has_factor ? Termination::kStalled : Termination::kIndefinite;
}

template <typename Pose>
Trial::Kind LevenbergMarquardt<Pose>::TryFactor(double most_promised, Descent<Pose>* descent) {
  factor_fits_ = false;
  const Linearization<Pose>& linearization = descent->linearization();
  last_step_ = linearization.Step();
  // The quadratic model falls by -(2 b^T dx + dx^T H dx), where (H + lambda D) dx = -b.
  double promised = linearization.UndampedDecrease(last_step_);
  if (damping_ > 0.0) {
    const Eigen::VectorXd damping = damping_ * linearization.Scale();
    promised += last_step_.dot(damping.cwiseProduct(last_step_));
  }
  if (promised > most_promised) return Trial::Kind::kRejected;
  const Trial trial = descent->TryStep(last_step_, promised);
  if (trial.kind != Trial::Kind::kTaken) return trial.kind;
  moved_ += last_step_.template lpNorm<Eigen::Infinity>();
  last_promised_ = promised;
  last_gain_ = trial.gain;
  factor_fits_ = damping_ == 0.0 && std::abs(last_gain_ - 1.0) < kGoodModel;
  return trial.kind;
}

// In a curved valley of F, a Gauss-Newton step along the valley raises F, and the next steps lower
// it again, further along the valley than damped steps would get. So some full steps are taken on
// trial (the watchdog technique of Chamberlain et al. 1982).
template <typename Pose>
bool LevenbergMarquardt<Pose>::LookAhead(const Eigen::VectorXd& first_step,
                                         Descent<Pose>* descent) {
  if (failed_trials_ >= kTrials) return false;
  Linearization<Pose>& linearization = descent->linearization();
  const auto start = descent->Save();
  const double enough = start.error + kWorthwhile * linearization.gradient().dot(first_step);
  Eigen::VectorXd dx = first_step;
  for (int step = 1; descent->may_continue(); ++step) {
    const double before = descent->error();
    descent->Step(dx);
    if (descent->error() < enough) {
      failed_trials_ = 0;
      return true;
    }
    const bool goes_on = step < kLookAhead || descent->error() < kReturns * before;
    if (!std::isfinite(descent->error()) || !goes_on) break;
    descent->Record(0.0);
    if (linearization.Factorize(0.0) == Definiteness::kIndefinite) break;
    dx = linearization.Step();
  }
  ++failed_trials_;
  descent->ReturnTo(start);
  return false;
}

// The damping at which a step of length |dx| (in the metric D of the scale) becomes |dx| / 2, by
// one step of Hebden's and More's iteration (More 1978) from no damping.
template <typename Pose>
double LevenbergMarquardt<Pose>::NaturalDamping(const Linearization<Pose>& linearization) const {
  const Eigen::VectorXd scaled = linearization.Scale().cwiseProduct(last_step_);
  const double natural = last_step_.dot(scaled) / scaled.dot(linearization.Solve(scaled));
  return natural > 0.0 ? std::min(kFirst, natural) : kFirst;
}

template <typename Pose>
bool LevenbergMarquardt<Pose>::IsFactorTrusted(const Linearization<Pose>& linearization) const {
  return moved_ * moved_ <= kSmallChange * linearization.smallest_pivot();
}

template <typename Pose>
void LevenbergMarquardt<Pose>::Strengthen() {
  damping_ = std::max(first_damping_, damping_ * kDampingFactor);
}

template <typename Pose>
void LevenbergMarquardt<Pose>::Weaken() {
  damping_ /= kDampingFactor;
  if (damping_ < first_damping_) damping_ = 0.0;
}

template class LevenbergMarquardt<SE2>;
template class LevenbergMarquardt<SE3>;

}  // namespace loopgrid
