#include "frontend/slam/closure_graph.h"

#include <Eigen/LU>
#include <algorithm>
#include <optional>

#include "backend/marginals.h"

namespace loopgrid {
namespace {

OptimizerOptions WhileGrowing() {
  OptimizerOptions options;
  options.max_iterations = 30;
  options.relative_decrease = 1e-4;
  options.absolute_decrease = 1e-3;
  options.loss.kind = LossKind::kHuber;
  return options;
}

OptimizerOptions AtTheEnd() {
  OptimizerOptions options;
  options.loss.kind = LossKind::kHuber;
  return options;
}

}  // namespace

ClosureGraph::ClosureGraph() : optimizer_(WhileGrowing()) {}

void ClosureGraph::AddNode(const SE2& T_map_node, const SE2& T_last_node,
                           const Eigen::Matrix3d& covariance) {
  const int node = size();
  graph_.poses.push_back(T_map_node);
  if (node == 0) {
    covariances_.assign(1, Eigen::Matrix3d::Zero());
    return;
  }
  graph_.constraints.push_back({node - 1, node, T_last_node, covariance.inverse(), false});
  ExtendRelativeCovariances(graph_, graph_.constraints.back(), &covariances_);
}

double ClosureGraph::Chi2(const Constraint& constraint) const {
  const SE2& from = graph_.poses[static_cast<std::size_t>(constraint.from)];
  const SE2& to = graph_.poses[static_cast<std::size_t>(constraint.to)];
  const Eigen::Vector3d e = (from.Inverse() * to).Boxminus(constraint.T_from_to);
  return e.dot(constraint.information * e);
}

double ClosureGraph::WorstChi2() const {
  double worst = 0.0;
  for (const Constraint& c : graph_.constraints) {
    if (c.robust) worst = std::max(worst, Chi2(c));
  }
  return worst;
}

bool ClosureGraph::TryClosures(std::span<const Constraint> closures) {
  const std::vector<SE2> poses_before = graph_.poses;
  const std::size_t constraints_before = graph_.constraints.size();
  const double limit = std::max(kMaxChi2, WorstChi2());
  graph_.constraints.insert(graph_.constraints.end(), closures.begin(), closures.end());
  optimizer_.Optimize(&graph_);
  if (WorstChi2() > limit) {
    graph_.constraints.resize(constraints_before);
    graph_.poses = poses_before;
    return false;
  }
  if (const std::optional<Marginals> marginals = optimizer_.ComputeMarginals()) {
    covariances_ = marginals->RelativeTo(size() - 1);
  }
  return true;
}

std::vector<Constraint> ClosureGraph::Settle(std::span<const Constraint> links) {
  graph_.constraints.insert(graph_.constraints.end(), links.begin(), links.end());
  Optimizer optimizer(AtTheEnd());
  std::vector<Constraint> removed;
  while (true) {
    optimizer.Optimize(&graph_);
    // The worst ones pull the others off: take out those near the worst, then look again.
    const double limit = std::max(kMaxChi2, 0.5 * WorstChi2());
    const auto kept =
        std::stable_partition(graph_.constraints.begin(), graph_.constraints.end(),
                              [&](const Constraint& c) { return !c.robust || Chi2(c) <= limit; });
    if (kept == graph_.constraints.end()) break;
    removed.insert(removed.end(), kept, graph_.constraints.end());
    graph_.constraints.erase(kept, graph_.constraints.end());
  }
  if (size() == 0) return removed;
  if (const std::optional<Marginals> marginals = optimizer.ComputeMarginals()) {
    covariances_ = marginals->RelativeTo(size() - 1);
  }
  return removed;
}

}  // namespace loopgrid
