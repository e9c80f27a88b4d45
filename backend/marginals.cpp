#include "backend/marginals.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cstddef>
#include <limits>
#include <utility>

#include "backend/base/error.h"
#include "backend/selected_inverse.h"

namespace loopgrid {
namespace {

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

Marginals::Marginals(std::vector<SE2> poses, const NormalEquations& equations,
                     const SparseCholesky<3>& factor)
    : poses_(std::move(poses)),
      equations_(&equations),
      factor_(&factor),
      covariances_(poses_.size(), Eigen::Matrix3d::Zero()) {
  const std::vector<Eigen::Matrix3d> of_variables = InverseDiagonal(factor);
  for (int node = 0; node < static_cast<int>(poses_.size()); ++node) {
    const int variable = equations.variable(node);
    if (variable >= 0) covariances_[Index(node)] = of_variables[Index(variable)];
  }
}

std::vector<Eigen::Matrix3d> Marginals::CrossCovariances(int node) const {
  std::vector<Eigen::Matrix3d> blocks(poses_.size(), Eigen::Matrix3d::Zero());
  const int variable = equations_->variable(node);
  if (variable < 0) return blocks;
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(3 * equations_->variable_count(), 3);
  unit.middleRows<3>(3 * variable).setIdentity();
  const Eigen::MatrixXd columns = factor_->Solve(unit);
  for (int i = 0; i < static_cast<int>(poses_.size()); ++i) {
    const int row = equations_->variable(i);
    if (row >= 0) blocks[Index(i)] = columns.middleRows<3>(3 * row);
  }
  return blocks;
}

std::vector<Eigen::Matrix3d> Marginals::RelativeTo(int node) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<Eigen::Matrix3d> cross = CrossCovariances(node);
  const std::vector<int>& components = equations_->components();
  const Eigen::Matrix3d& own = covariances_[Index(node)];
  std::vector<Eigen::Matrix3d> relative(poses_.size());
  for (int i = 0; i < static_cast<int>(poses_.size()); ++i) {
    if (i == node) {
      relative[Index(i)].setZero();
    } else if (components[Index(i)] != components[Index(node)]) {
      relative[Index(i)] = Eigen::Vector3d::Constant(kInfinity).asDiagonal();
    } else {
      // A motion d of `node` moves node i, seen from there, by -A d.
      const Eigen::Matrix3d A = (poses_[Index(i)].Inverse() * poses_[Index(node)]).Adjoint();
      const Eigen::Matrix3d mixed = cross[Index(i)] * A.transpose();
      const Eigen::Matrix3d sum =
          covariances_[Index(i)] - mixed - mixed.transpose() + A * own * A.transpose();
      relative[Index(i)] = 0.5 * (sum + sum.transpose());
    }
  }
  return relative;
}

std::optional<std::vector<Eigen::Matrix3d>> RelativeCovariances(const PoseGraph& graph, int node,
                                                                const RobustLoss& loss) {
  Validate(graph);
  if (node < 0 || Index(node) >= graph.poses.size()) {
    throw Error(ErrorCode::kInput, fmt::format("node {} is asked for, but the graph has {} nodes",
                                               node, graph.poses.size()));
  }
  NormalEquations equations;
  equations.SetStructure(graph);
  equations.Linearize(graph, loss);
  SparseCholesky<3> factor;
  factor.Analyze(equations.hessian());
  if (!factor.Factorize(equations.hessian())) return std::nullopt;
  return Marginals(graph.poses, equations, factor).RelativeTo(node);
}

void ExtendRelativeCovariances(const PoseGraph& graph, const Constraint& link,
                               std::vector<Eigen::Matrix3d>* covariances) {
  // The link's error is independent of all others and moves every node alike, seen from the new
  // one.
  const SE2& last = graph.poses[Index(link.to)];
  const Eigen::Matrix3d error = link.information.inverse();
  for (std::size_t i = 0; i < covariances->size(); ++i) {
    const Eigen::Matrix3d A = (graph.poses[i].Inverse() * last).Adjoint();
    (*covariances)[i] += A * error * A.transpose();
  }
  covariances->push_back(Eigen::Matrix3d::Zero());
}

}  // namespace loopgrid
