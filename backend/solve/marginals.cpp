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

/// See RefineFactor. The bound is some thousand times too large on long chains.
constexpr double kMostRelativeNoise = 1e-3;

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
typename Marginals<Pose>::Covariance Marginals<Pose>::NodeDifference(int i, int node,
                                                                     const Covariance& cross,
                                                                     bool* is_exact) const {
  // A motion d of `node` moves node i, seen from there, by -A d.
  const Covariance A = (graph_.poses[ToIndex(i)].Inverse() * graph_.poses[ToIndex(node)]).Adjoint();
  const Covariance mixed = cross * A.transpose();
  const Covariance moved = A * covariances_[ToIndex(node)] * A.transpose();
  const Covariance& of_node = covariances_[ToIndex(i)];
  const Covariance sum = of_node - mixed - mixed.transpose() + moved;
  *is_exact = IsAccurate<kDof>(sum.diagonal(), (of_node + moved).diagonal());
  return 0.5 * (sum + sum.transpose());
}

template <typename Pose>
typename Marginals<Pose>::PointCovariance Marginals<Pose>::LandmarkDifference(
    int i, int node, const Eigen::Matrix<double, kPoint, kDof>& cross, bool* is_exact) const {
  const Pose& pose = graph_.poses[ToIndex(node)];
  // A motion d of `node` moves the landmark, seen from there, by R J d in the map's axes.
  const auto J = Linearize(pose, graph_.landmarks[ToIndex(i)], Pose::Point::Zero().eval()).J_node;
  const Eigen::Matrix<double, kPoint, kDof> A = pose.rotation() * J;
  const PointCovariance mixed = cross * A.transpose();
  const PointCovariance moved = A * covariances_[ToIndex(node)] * A.transpose();
  const PointCovariance& of_landmark = landmark_covariances_[ToIndex(i)];
  const PointCovariance sum = of_landmark + mixed + mixed.transpose() + moved;
  *is_exact = IsAccurate<kPoint>(sum.diagonal(), (of_landmark + moved).diagonal());
  return 0.5 * (sum + sum.transpose());
}

template <typename Pose>
typename Marginals<Pose>::Relative Marginals<Pose>::Differences(int node, bool* are_exact) const {
  const Components& components = equations_->components();
  const int component = components.of_node[ToIndex(node)];
  Relative relative{covariances_, landmark_covariances_};
  const Eigen::MatrixXd columns = ColumnsOf(node);
  if (columns.size() == 0) return relative;  // it is held
  for (int i = 0; i < static_cast<int>(relative.nodes.size()); ++i) {
    if (i == node || components.of_node[ToIndex(i)] != component) continue;
    const int variable = equations_->variable(i);
    const Covariance cross = variable < 0 ? Covariance(Covariance::Zero())
                                          : Covariance(columns.middleRows<kDof>(kDof * variable));
    bool is_exact = true;
    relative.nodes[ToIndex(i)] = NodeDifference(i, node, cross, &is_exact);
    *are_exact &= is_exact;
  }
  relative.nodes[ToIndex(node)].setZero();
  for (int i = 0; i < static_cast<int>(relative.landmarks.size()); ++i) {
    if (components.of_landmark[ToIndex(i)] != component) continue;
    const int row = kDof * equations_->landmark_variable(i);
    bool is_exact = true;
    relative.landmarks[ToIndex(i)] =
        LandmarkDifference(i, node, columns.template middleRows<kPoint>(row), &is_exact);
    *are_exact &= is_exact;
  }
  return relative;
}

template <typename Pose>
std::optional<typename Marginals<Pose>::Relative> Marginals<Pose>::WithHeld(int node) const {
  PoseGraph<Pose> graph = graph_;
  const std::vector<int>& components = equations_->components().of_node;
  const auto is_near = [&](int other) {
    return components[ToIndex(other)] == components[ToIndex(node)];
  };
  if (std::erase_if(graph.fixed, is_near) > 1) return std::nullopt;
  graph.fixed.push_back(node);
  NormalEquations<Pose> equations;
  equations.SetStructure(graph);
  const Objective objective{loss_, Parametrization::kManifold};
  equations.Linearize(graph, objective);
  SparseCholesky<kDof> factor;
  factor.Analyze(equations.hessian());
  if (FactorizeHessian(graph, objective, equations, {}, &factor) != Definiteness::kDefinite) {
    return std::nullopt;
  }
  RefineFactor(graph, objective, equations, kMostRelativeNoise, &factor);
  const Marginals held(graph, equations, factor, loss_);
  return Relative{held.covariances_, held.landmark_covariances_};
}

template <typename Pose>
typename Marginals<Pose>::Relative Marginals<Pose>::RelativeTo(int node) const {
  RequireNode(node);
  bool are_exact = true;
  Relative relative = Differences(node, &are_exact);
  if (!are_exact) {
    if (auto held = WithHeld(node)) relative = std::move(*held);
  }
  const Components& components = equations_->components();
  const int component = components.of_node[ToIndex(node)];
  SetInfiniteOutside(components.of_node, component, &relative.nodes);
  SetInfiniteOutside(components.of_landmark, component, &relative.landmarks);
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
  RefineFactor(graph, objective, equations, kMostRelativeNoise, &factor);
  return Marginals<Pose>(graph, equations, factor, loss).RelativeTo(node).nodes;
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
