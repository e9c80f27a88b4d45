#include "backend/solve/marginals.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>

#include "backend/base/error.h"
#include "backend/base/index.h"
#include "backend/graph/constraint_error.h"
#include "backend/solve/hessian_factorization.h"
#include "backend/sparse/selected_inverse.h"

namespace loopgrid {
namespace {

/// Where the terms of a variance are this many times the variance, their difference has lost six of
/// the sixteen digits of a double, beside those that the condition of the Hessian costs the terms.
constexpr double kMostCancellation = 1e6;

/// Whether variances that are differences of terms of these sizes have kept enough digits.
template <int kSize>
bool IsAccurate(const Eigen::Matrix<double, kSize, 1>& variances,
                const Eigen::Matrix<double, kSize, 1>& terms) {
  return (kMostCancellation * variances.array() >= terms.array()).all();
}

Error NoSuchNode(int node, std::size_t nodes) {
  return Error(ErrorCode::kInput,
               fmt::format("node {} is asked for, but the graph has {} nodes", node, nodes));
}

template <typename Covariance>
void SetInfiniteOutside(const std::vector<int>& components, int component,
                        std::vector<Covariance>* covariances) {
  for (std::size_t i = 0; i < covariances->size(); ++i) {
    if (components[i] == component) continue;
    (*covariances)[i].setZero();
    (*covariances)[i].diagonal().setConstant(std::numeric_limits<double>::infinity());
  }
}

template <typename Pose>
struct NodesAndLandmarks {
  std::vector<typename Marginals<Pose>::Covariance> nodes;
  std::vector<typename Marginals<Pose>::PointCovariance> landmarks;
};

/// The covariances with `node` held instead of the node that is held in its component. Nothing if
/// several nodes of the component are fixed, or if the Hessian is not positive definite.
template <typename Pose>
std::optional<NodesAndLandmarks<Pose>> CovariancesWithHeld(PoseGraph<Pose> graph,
                                                           const std::vector<int>& components,
                                                           int node, const RobustLoss& loss) {
  const auto is_near = [&](int other) {
    return components[ToIndex(other)] == components[ToIndex(node)];
  };
  if (std::erase_if(graph.fixed, is_near) > 1) return std::nullopt;
  graph.fixed.push_back(node);
  NormalEquations<Pose> equations;
  equations.SetStructure(graph);
  const Objective objective{loss, Parametrization::kManifold};
  equations.Linearize(graph, objective);
  SparseCholesky<Pose::kDof> factor;
  factor.Analyze(equations.hessian());
  if (FactorizeHessian(graph, objective, equations, {}, &factor) != Definiteness::kDefinite) {
    return std::nullopt;
  }
  const Marginals<Pose> marginals(graph, equations, factor, loss);
  return NodesAndLandmarks<Pose>{marginals.covariances(), marginals.landmark_covariances()};
}

}  // namespace

template <typename Pose>
Marginals<Pose>::Marginals(const PoseGraph<Pose>& graph, const NormalEquations<Pose>& equations,
                           const SparseCholesky<kDof>& factor, const RobustLoss& loss)
    : graph_(graph),
      loss_(loss),
      equations_(&equations),
      factor_(&factor),
      covariances_(graph.poses.size(), Covariance::Zero()),
      landmark_covariances_(ToIndex(equations.landmark_count()), PointCovariance::Zero()) {
  const std::vector<Covariance> of_variables = InverseDiagonal(factor);
  for (int node = 0; node < static_cast<int>(graph.poses.size()); ++node) {
    const int variable = equations.variable(node);
    if (variable >= 0) covariances_[ToIndex(node)] = of_variables[ToIndex(variable)];
  }
  for (int landmark = 0; landmark < equations.landmark_count(); ++landmark) {
    const int variable = equations.landmark_variable(landmark);
    if (variable < 0) continue;
    landmark_covariances_[ToIndex(landmark)] =
        of_variables[ToIndex(variable)].template topLeftCorner<kPoint, kPoint>();
  }
}

template <typename Pose>
void Marginals<Pose>::RequireNode(int node) const {
  if (node < 0 || ToIndex(node) >= graph_.poses.size()) throw NoSuchNode(node, graph_.poses.size());
}

template <typename Pose>
Eigen::MatrixXd Marginals<Pose>::ColumnsOf(int node) const {
  const int variable = equations_->variable(node);
  if (variable < 0) return {};
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(kDof * equations_->variable_count(), kDof);
  unit.middleRows<kDof>(kDof * variable).setIdentity();
  return factor_->Solve(unit);
}

template <typename Pose>
std::vector<typename Marginals<Pose>::Covariance> Marginals<Pose>::CrossCovariances(
    int node) const {
  RequireNode(node);
  std::vector<Covariance> blocks(graph_.poses.size(), Covariance::Zero());
  const Eigen::MatrixXd columns = ColumnsOf(node);
  if (columns.size() == 0) return blocks;
  for (int i = 0; i < static_cast<int>(graph_.poses.size()); ++i) {
    const int row = equations_->variable(i);
    if (row >= 0) blocks[ToIndex(i)] = columns.middleRows<kDof>(kDof * row);
  }
  return blocks;
}

template <typename Pose>
std::vector<typename Marginals<Pose>::Covariance> Marginals<Pose>::PairCovariances(
    std::span<const std::pair<int, int>> pairs) const {
  std::map<int, std::vector<std::size_t>> places_of_second;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    RequireNode(pairs[k].first);
    RequireNode(pairs[k].second);
    places_of_second[pairs[k].second].push_back(k);
  }
  std::vector<Covariance> blocks(pairs.size());
  for (const auto& [second, places] : places_of_second) {
    const std::vector<Covariance> columns = CrossCovariances(second);
    for (std::size_t k : places) blocks[k] = columns[ToIndex(pairs[k].first)];
  }
  return blocks;
}

template <typename Pose>
std::vector<typename Marginals<Pose>::Covariance> Marginals<Pose>::Differences(
    int node, bool* are_exact) const {
  const std::vector<Covariance> cross = CrossCovariances(node);
  const std::vector<int>& components = equations_->components().of_node;
  const Covariance& own = covariances_[ToIndex(node)];
  std::vector<Covariance> relative(graph_.poses.size(), Covariance::Zero());
  for (int i = 0; i < static_cast<int>(graph_.poses.size()); ++i) {
    if (i == node || components[ToIndex(i)] != components[ToIndex(node)]) continue;
    // A motion d of `node` moves node i, seen from there, by -A d.
    const Covariance A =
        (graph_.poses[ToIndex(i)].Inverse() * graph_.poses[ToIndex(node)]).Adjoint();
    const Covariance mixed = cross[ToIndex(i)] * A.transpose();
    const Covariance moved = A * own * A.transpose();
    const Covariance& of_node = covariances_[ToIndex(i)];
    const Covariance sum = of_node - mixed - mixed.transpose() + moved;
    *are_exact &= IsAccurate<Pose::kDof>(sum.diagonal(), (of_node + moved).diagonal());
    relative[ToIndex(i)] = 0.5 * (sum + sum.transpose());
  }
  return relative;
}

template <typename Pose>
std::vector<typename Marginals<Pose>::PointCovariance> Marginals<Pose>::LandmarkDifferences(
    int node, bool* are_exact) const {
  const Components& components = equations_->components();
  const Pose& pose = graph_.poses[ToIndex(node)];
  const Eigen::MatrixXd columns = ColumnsOf(node);
  std::vector<PointCovariance> relative = landmark_covariances_;
  if (columns.size() == 0) return relative;
  for (int i = 0; i < static_cast<int>(relative.size()); ++i) {
    if (components.of_landmark[ToIndex(i)] != components.of_node[ToIndex(node)]) continue;
    // A motion d of `node` moves the landmark, seen from there, by R J d in the map's axes.
    const auto J = Linearize(pose, graph_.landmarks[ToIndex(i)], Pose::Point::Zero().eval()).J_node;
    const Eigen::Matrix<double, kPoint, kDof> A = pose.rotation() * J;
    const int row = kDof * equations_->landmark_variable(i);
    const PointCovariance mixed = columns.template middleRows<kPoint>(row) * A.transpose();
    const PointCovariance moved = A * covariances_[ToIndex(node)] * A.transpose();
    PointCovariance& sum = relative[ToIndex(i)];
    const PointCovariance terms = sum + moved;
    sum += mixed + mixed.transpose() + moved;
    *are_exact &= IsAccurate<kPoint>(sum.diagonal(), terms.diagonal());
  }
  return relative;
}

template <typename Pose>
std::vector<typename Marginals<Pose>::Covariance> Marginals<Pose>::RelativeTo(int node) const {
  RequireNode(node);
  const std::vector<int>& components = equations_->components().of_node;
  const int component = components[ToIndex(node)];
  bool are_exact = true;
  std::vector<Covariance> relative = Differences(node, &are_exact);
  if (!are_exact) {
    if (auto held = CovariancesWithHeld(graph_, components, node, loss_)) {
      relative = std::move(held->nodes);
    }
  }
  SetInfiniteOutside(components, component, &relative);
  return relative;
}

template <typename Pose>
std::vector<typename Marginals<Pose>::PointCovariance> Marginals<Pose>::LandmarksRelativeTo(
    int node) const {
  RequireNode(node);
  const Components& components = equations_->components();
  bool are_exact = true;
  std::vector<PointCovariance> relative = LandmarkDifferences(node, &are_exact);
  if (!are_exact) {
    if (auto held = CovariancesWithHeld(graph_, components.of_node, node, loss_)) {
      relative = std::move(held->landmarks);
    }
  }
  SetInfiniteOutside(components.of_landmark, components.of_node[ToIndex(node)], &relative);
  return relative;
}

template <typename Pose>
std::optional<std::vector<typename Marginals<Pose>::Covariance>> RelativeCovariances(
    const PoseGraph<Pose>& graph, int node, const RobustLoss& loss) {
  Validate(graph);
  if (node < 0 || ToIndex(node) >= graph.poses.size()) throw NoSuchNode(node, graph.poses.size());
  NormalEquations<Pose> equations;
  equations.SetStructure(graph);
  const Objective objective{loss, Parametrization::kManifold};
  equations.Linearize(graph, objective);
  SparseCholesky<Pose::kDof> factor;
  factor.Analyze(equations.hessian());
  if (FactorizeHessian(graph, objective, equations, {}, &factor) != Definiteness::kDefinite) {
    return std::nullopt;
  }
  return Marginals<Pose>(graph, equations, factor, loss).RelativeTo(node);
}

template <typename Pose>
void ExtendRelativeCovariances(const PoseGraph<Pose>& graph, const Constraint<Pose>& link,
                               std::vector<typename Marginals<Pose>::Covariance>* covariances) {
  using Covariance = typename Marginals<Pose>::Covariance;
  // The link's error is independent of all others and moves every node alike, seen from the new
  // one.
  const Pose& last = graph.poses[ToIndex(link.to)];
  const Covariance error = link.information.inverse();
  for (std::size_t i = 0; i < covariances->size(); ++i) {
    const Covariance A = (graph.poses[i].Inverse() * last).Adjoint();
    (*covariances)[i] += A * error * A.transpose();
  }
  covariances->push_back(Covariance::Zero());
}

#define LOOPGRID_INSTANTIATE(Pose)                                                         \
  template class Marginals<Pose>;                                                          \
  template std::optional<std::vector<Marginals<Pose>::Covariance>> RelativeCovariances(    \
      const PoseGraph<Pose>&, int, const RobustLoss&);                                     \
  template void ExtendRelativeCovariances(const PoseGraph<Pose>&, const Constraint<Pose>&, \
                                          std::vector<Marginals<Pose>::Covariance>*);
LOOPGRID_INSTANTIATE(SE2)
LOOPGRID_INSTANTIATE(SE3)
#undef LOOPGRID_INSTANTIATE

}  // namespace loopgrid
