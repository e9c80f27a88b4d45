#include "backend/solve/gauss_newton.h"

namespace loopgrid {

template <typename Pose>
std::optional<Termination> GaussNewton<Pose>::MakeStep(Descent<Pose>* descent) {
  Linearization<Pose>& linearization = descent->linearization();
  if (linearization.Factorize(0.0) != Definiteness::kDefinite) return Termination::kIndefinite;
  const Eigen::VectorXd dx = linearization.Step();
  if (-linearization.gradient().dot(dx) <= descent->negligible()) return Termination::kConverged;
  descent->Step(dx);
  return std::nullopt;
}

template class GaussNewton<SE2>;
template class GaussNewton<SE3>;

}  // namespace loopgrid
