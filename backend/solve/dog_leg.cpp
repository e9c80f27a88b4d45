#include "backend/solve/dog_leg.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "backend/solve/dog_leg_path.h"

namespace loopgrid {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr double kSmallestRadius = 1e-12;

// Of the Hessian's diagonal.
constexpr double kFirstDamping = 1e-5;
constexpr double kLargestDogLegDamping = 1e10;
constexpr double kDogLegDampingFactor = 10.0;

}  // namespace

template <typename Pose>
std::optional<Termination> DogLeg<Pose>::MakeStep(Descent<Pose>* descent) {
  Linearization<Pose>& linearization = descent->linearization();
  while (linearization.Factorize(damping_) == Definiteness::kIndefinite) {
    damping_ = std::max(kFirstDamping, damping_ * kDogLegDampingFactor);
    if (damping_ > kLargestDogLegDamping) return Termination::kIndefinite;
  }
  const Eigen::VectorXd& b = linearization.gradient();
  const Eigen::VectorXd newton = linearization.Step();
  if (linearization.UndampedDecrease(newton) <= descent->negligible()) {
    return damping_ == 0.0 ? Termination::kConverged : Termination::kIndefinite;
  }
  const Eigen::VectorXd scale = linearization.Scale();
  Eigen::VectorXd cauchy = -b.cwiseQuotient(scale);
  cauchy *= -b.dot(cauchy) / linearization.Curvature(cauchy);  // to the minimum along it
  const DogLegPath path(cauchy, newton, scale);

  while (radius_ > kSmallestRadius) {
    const Eigen::VectorXd dx = path.PointWithin(radius_);
    const double promised = -2.0 * b.dot(dx) - linearization.Curvature(dx);
    const Trial trial = descent->TryStep(dx, promised);
    if (trial.kind == Trial::Kind::kNegligible) return Termination::kStalled;
    const bool is_taken = trial.kind == Trial::Kind::kTaken;
    radius_ = NextRadius(radius_, path.Length(dx), is_taken ? trial.gain : -kUnbounded);
    if (!is_taken && !std::isfinite(radius_)) break;  // the step's length overflows
    if (!is_taken) continue;
    damping_ /= kDogLegDampingFactor;
    if (damping_ < kFirstDamping) damping_ = 0.0;
    return std::nullopt;
  }
  return Termination::kStalled;
}

template class DogLeg<SE2>;
template class DogLeg<SE3>;

}  // namespace loopgrid
