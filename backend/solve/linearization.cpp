#include "backend/solve/linearization.h"

#include <cstddef>

#include "backend/base/index.h"
#include "backend/graph/parametrization.h"
#include "backend/solve/hessian_factorization.h"

namespace loopgrid {
namespace {

constexpr double kSmallestScale = 1e-9;

/// Keeps steps from going along directions that F does not depend on. The gradient along them,
/// which is zero but for rounding errors of 1e-16, makes steps of a hundredth of the errors at
/// most.
constexpr double kFreeDamping = 1e-14;

/// A step that is not exact is corrected by the next one. Covariances are not: beyond this share of
/// a pivot that may be rounding errors, they are computed with twice the digits.
constexpr double kMostNoise = 1e-2;

}  // namespace

template <typename Pose>
void Linearization<Pose>::SetStructure(const PoseGraph<Pose>& graph) {
  has_undamped_factor_ = false;
  if (equations_.SetStructure(graph)) factor_.Analyze(equations_.hessian());
}

template <typename Pose>
double Linearization<Pose>::Linearize(const PoseGraph<Pose>& graph, const Objective& objective) {
  has_undamped_factor_ = false;
  free_decrease_.reset();
  graph_ = &graph;
  objective_ = objective;
  return equations_.Linearize(graph, objective, &workers_);
}

template <typename Pose>
Definiteness Linearization<Pose>::Factorize(double damping) {
  const auto factorize = [this](const Eigen::VectorXd& added) {
    return FactorizeHessian(*graph_, objective_, equations_, added, &factor_);
  };
  const Definiteness result = factorize(damping > 0.0 ? damping * Scale() : Eigen::VectorXd());
  has_undamped_factor_ = result == Definiteness::kDefinite && damping == 0.0;
  free_decrease_.reset();
  if (result != Definiteness::kSemidefinite) return result;
  // Of the many minima of the model the factor gives one, perhaps far away along a free direction;
  // how low it is is the same for all.
  const double decrease = -gradient().dot(Step());
  if (factorize(kFreeDamping * Scale()) == Definiteness::kIndefinite) {
    return Definiteness::kIndefinite;
  }
  free_decrease_ = decrease;
  return result;
}

template <typename Pose>
Definiteness Linearization<Pose>::FactorizeForCovariances(const PoseGraph<Pose>& graph,
                                                          bool careful) {
  if (!has_undamped_factor_) {
    const Definiteness result =
        FactorizeHessian(graph, objective_, equations_, Eigen::VectorXd(), &factor_);
    has_undamped_factor_ = result == Definiteness::kDefinite;
    if (!has_undamped_factor_) return result;
  }
  if (!careful || factor_.LargestNoise() <= kMostNoise) return Definiteness::kDefinite;
  if (factor_.FactorizeExactly(ExactHessian(graph, objective_, equations_)) ==
      Definiteness::kDefinite) {
    return Definiteness::kDefinite;
  }
  // Its bounds of rounding errors are too large on long chains: there double precision is enough.
  return FactorizeHessian(graph, objective_, equations_, Eigen::VectorXd(), &factor_);
}

template <typename Pose>
Eigen::VectorXd Linearization<Pose>::Scale() const {
  const auto& H = equations_.hessian();
  Eigen::VectorXd scale(kDof * H.cols());
  for (int i = 0; i < H.cols(); ++i) {
    scale.segment<kDof>(kDof * i) = H.diagonal(i).diagonal();
  }
  return scale.cwiseMax(kSmallestScale * scale.maxCoeff());
}

template <typename Pose>
void Linearization<Pose>::Move(const Eigen::VectorXd& dx, Parametrization parametrization,
                               PoseGraph<Pose>* graph) const {
  for (int node = 0; node < static_cast<int>(graph->poses.size()); ++node) {
    const int variable = equations_.variable(node);
    if (variable < 0) continue;
    Pose& pose = graph->poses[ToIndex(node)];
    pose = Increment<Pose>(pose, dx.segment<kDof>(kDof * variable), parametrization);
  }
  for (int landmark = 0; landmark < static_cast<int>(graph->landmarks.size()); ++landmark) {
    const int variable = equations_.landmark_variable(landmark);
    if (variable < 0) continue;
    constexpr int kPoint = Pose::Point::RowsAtCompileTime;
    graph->landmarks[ToIndex(landmark)] += dx.segment<kPoint>(kDof * variable);
  }
}

template class Linearization<SE2>;
template class Linearization<SE3>;

}  // namespace loopgrid
