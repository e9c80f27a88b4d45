#include "backend/solve/marginals.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>

#include "backend/base/error.h"
#include "backend/graph/constraint_error.h"
#include "backend/sparse/selected_inverse.h"

namespace loopgrid {
namespace {

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

template <typename Pose>
Marginals<Pose>::Marginals(const PoseGraph<Pose>& graph, const NormalEquations<Pose>& equations,
                           const SparseCholesky<kDof>& factor)
    : poses_(graph.poses),
      landmarks_(graph.landmarks),
      equations_(&equations),
      factor_(&factor),
      covariances_(poses_.size(), Covariance::Zero()),
      landmark_covariances_(Index(equations.landmark_count()), PointCovariance::Zero()) {
  const std::vector<Covariance> of_variables = InverseDiagonal(factor);
  for (int node = 0; node < static_cast<int>(poses_.size()); ++node) {
    const int variable = equations.variable(node);
    if (variable >= 0) covariances_[Index(node)] = of_variables[Index(variable)];
  }
  for (int landmark = 0; landmark < equations.landmark_count(); ++landmark) {
    const int variable = equations.landmark_variable(landmark);
    if (variable < 0) continue;
    landmark_covariances_[Index(landmark)] =
        of_variables[Index(variable)].template topLeftCorner<kPoint, kPoint>();
  }
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
  std::vector<Covariance> blocks(poses_.size(), Covariance::Zero());
  const Eigen::MatrixXd columns = ColumnsOf(node);
  if (columns.size() == 0) return blocks;
  for (int i = 0; i < static_cast<int>(poses_.size()); ++i) {
    const int row = equations_->variable(i);
    if (row >= 0) blocks[Index(i)] = columns.middleRows<kDof>(kDof * row);
  }
  return blocks;
}

template <typename Pose>
std::vector<typename Marginals<Pose>::Covariance> Marginals<Pose>::PairCovariances(
    std::span<const std::pair<int, int>> pairs) const {
  std::map<int, std::vector<std::size_t>> places_of_second;
  for (std::size_t k = 0; k < pairs.size(); ++k) places_of_second[pairs[k].second].push_back(k);
  std::vector<Covariance> blocks(pairs.size());
  for (const auto& [second, places] : places_of_second) {
    const std::vector<Covariance> columns = CrossCovariances(second);
    for (std::size_t k : places) blocks[k] = columns[Index(pairs[k].first)];
  }
  return blocks;
}

template <typename Pose>
std::vector<typename Marginals<Pose>::Covariance> Marginals<Pose>::RelativeTo(int node) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<Covariance> cross = CrossCovariances(node);
  const std::vector<int>& components = equations_->components().of_node;
  const Covariance& own = covariances_[Index(node)];
  std::vector<Covariance> relative(poses_.size());
  for (int i = 0; i < static_cast<int>(poses_.size()); ++i) {
    if (i == node) {
      relative[Index(i)].setZero();
    } else if (components[Index(i)] != components[Index(node)]) {
      relative[Index(i)] = Pose::Tangent::Constant(kInfinity).asDiagonal();
    } else {
      // A motion d of `node` moves node i, seen from there, by -A d.
      const Covariance A = (poses_[Index(i)].Inverse() * poses_[Index(node)]).Adjoint();
      const Covariance mixed = cross[Index(i)] * A.transpose();
      const Covariance sum =
          covariances_[Index(i)] - mixed - mixed.transpose() + A * own * A.transpose();
      relative[Index(i)] = 0.5 * (sum + sum.transpose());
    }
  }
  return relative;
}

template <typename Pose>
std::vector<typename Marginals<Pose>::PointCovariance> Marginals<Pose>::LandmarksRelativeTo(
    int node) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Components& components = equations_->components();
  const Pose& pose = poses_[Index(node)];
  const Eigen::MatrixXd columns = ColumnsOf(node);
  std::vector<PointCovariance> relative = landmark_covariances_;
  for (int i = 0; i < static_cast<int>(relative.size()); ++i) {
    if (components.of_landmark[Index(i)] != components.of_node[Index(node)]) {
      relative[Index(i)] = Pose::Point::Constant(kInfinity).asDiagonal();
    } else if (columns.size() > 0) {
      // A motion d of `node` moves the landmark, seen from there, by R J d in the map's axes.
      const auto J = Linearize(pose, landmarks_[Index(i)], Pose::Point::Zero().eval()).J_node;
      const Eigen::Matrix<double, kPoint, kDof> A = pose.rotation() * J;
      const int row = kDof * equations_->landmark_variable(i);
      const PointCovariance mixed = columns.template middleRows<kPoint>(row) * A.transpose();
      relative[Index(i)] +=
          mixed + mixed.transpose() + A * covariances_[Index(node)] * A.transpose();
    }
  }
  return relative;
}

template <typename Pose>
std::optional<std::vector<typename Marginals<Pose>::Covariance>> RelativeCovariances(
    const PoseGraph<Pose>& graph, int node, const RobustLoss& loss) {
  Validate(graph);
  if (node < 0 || Index(node) >= graph.poses.size()) {
    throw Error(ErrorCode::kInput, fmt::format("node {} is asked for, but the graph has {} nodes",
                                               node, graph.poses.size()));
  }
  NormalEquations<Pose> equations;
  equations.SetStructure(graph);
  equations.Linearize(graph, {loss, Parametrization::kManifold});
  SparseCholesky<Pose::kDof> factor;
  factor.Analyze(equations.hessian());
  if (!factor.Factorize(equations.hessian())) return std::nullopt;
  return Marginals<Pose>(graph, equations, factor).RelativeTo(node);
}

template <typename Pose>
void ExtendRelativeCovariances(const PoseGraph<Pose>& graph, const Constraint<Pose>& link,
                               std::vector<typename Marginals<Pose>::Covariance>* covariances) {
  using Covariance = typename Marginals<Pose>::Covariance;
  // The link's error is independent of all others and moves every node alike, seen from the new
  // one.
  const Pose& last = graph.poses[Index(link.to)];
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
