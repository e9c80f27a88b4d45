#include "frontend/closing/closure_graph.h"

#include <Eigen/LU>
#include <algorithm>
#include <optional>
#include <utility>

#include "backend/solve/marginals.h"

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

Eigen::Matrix3d ComposeCovariances(const Eigen::Matrix3d& first, const SE2& step,
                                   const Eigen::Matrix3d& second) {
  const Eigen::Matrix3d A = step.Inverse().Adjoint();
  const Eigen::Matrix3d sum = A * first * A.transpose() + second;
  return 0.5 * (sum + sum.transpose());  // symmetric to the last bit
}

ClosureGraph::ClosureGraph() : optimizer_(WhileGrowing()) {}

void ClosureGraph::AddNode(const SE2& T_map_node, const SE2& T_parent_node,
                           const Eigen::Matrix3d& covariance, int parent) {
  const int node = size();
  if (node == 0) {
    graph_.poses.push_back(T_map_node);
    covariances_.assign(1, Eigen::Matrix3d::Zero());
    map_covariances_.assign(1, Eigen::Matrix3d::Zero());
    return;
  }
  if (parent < 0) parent = node - 1;
  if (parent != node - 1) UpdateCovariances(&optimizer_, parent);
  graph_.poses.push_back(T_map_node);
  graph_.constraints.push_back({parent, node, T_parent_node, covariance.inverse(), false});
  ExtendRelativeCovariances(graph_, graph_.constraints.back(), &covariances_);
  map_covariances_.push_back(ComposeCovariances(map_covariances_[static_cast<std::size_t>(parent)],
                                                T_parent_node, covariance));
}

void ClosureGraph::MoveNodes(int first, const SE2& motion) {
  for (int k = first; k < size(); ++k) {
    SE2& pose = graph_.poses[static_cast<std::size_t>(k)];
    pose = motion * pose;
  }
}

double ClosureGraph::Chi2(const Constraint<SE2>& constraint) const {
  const SE2& from = graph_.poses[static_cast<std::size_t>(constraint.from)];
  const SE2& to = graph_.poses[static_cast<std::size_t>(constraint.to)];
  const Eigen::Vector3d e = (from.Inverse() * to).Boxminus(constraint.T_from_to);
  return e.dot(constraint.information * e);
}

int ClosureGraph::WorstClosure() const {
  int worst = -1;
  double worst_chi2 = kMaxChi2;
  for (std::size_t k = 0; k < graph_.constraints.size(); ++k) {
    const Constraint<SE2>& c = graph_.constraints[k];
    if (!c.robust) continue;
    const double chi2 = Chi2(c);
    if (chi2 <= worst_chi2) continue;
    worst = static_cast<int>(k);
    worst_chi2 = chi2;
  }
  return worst;
}

bool ClosureGraph::TryClosures(std::span<const Constraint<SE2>> closures,
                               std::vector<Constraint<SE2>>* removed) {
  const PoseGraph<SE2> before = graph_;
  int old_ones = static_cast<int>(graph_.constraints.size());
  int new_ones = static_cast<int>(closures.size());
  std::vector<Constraint<SE2>> contradicted;
  graph_.constraints.insert(graph_.constraints.end(), closures.begin(), closures.end());
  optimizer_.Optimize(&graph_);
  for (int worst = WorstClosure(); worst >= 0; worst = WorstClosure()) {
    // Old closures give way to new ones only while those are more.
    --(worst < old_ones ? old_ones : new_ones);
    contradicted.push_back(graph_.constraints[static_cast<std::size_t>(worst)]);
    const int given_up = static_cast<int>(before.constraints.size()) - old_ones;
    if (new_ones == 0 || given_up > new_ones) {
      graph_ = before;
      return false;
    }
    graph_.constraints.erase(graph_.constraints.begin() + worst);
    optimizer_.Optimize(&graph_);
  }
  if (removed != nullptr) *removed = std::move(contradicted);
  UpdateCovariances(&optimizer_, size() - 1);
  return true;
}

void ClosureGraph::UpdateCovariances(Optimizer<SE2>* optimizer, int relative_to) {
  if (const std::optional<Marginals<SE2>> marginals = optimizer->ComputeMarginals(graph_)) {
    covariances_ = marginals->RelativeTo(relative_to);
    map_covariances_ = marginals->covariances();
  }
}

std::vector<Constraint<SE2>> ClosureGraph::Settle(std::span<const Constraint<SE2>> links) {
  std::vector<Constraint<SE2>> removed;
  if (size() == 0) return removed;
  graph_.constraints.insert(graph_.constraints.end(), links.begin(), links.end());
  Optimizer<SE2> optimizer(AtTheEnd());
  optimizer.Optimize(&graph_);
  for (int worst = WorstClosure(); worst >= 0; worst = WorstClosure()) {
    // Wrong ones pull their neighbours off: take out those near the worst, then look again.
    const double limit =
        std::max(kMaxChi2, 0.5 * Chi2(graph_.constraints[static_cast<std::size_t>(worst)]));
    const auto kept = std::stable_partition(
        graph_.constraints.begin(), graph_.constraints.end(),
        [&](const Constraint<SE2>& c) { return !c.robust || Chi2(c) <= limit; });
    removed.insert(removed.end(), kept, graph_.constraints.end());
    graph_.constraints.erase(kept, graph_.constraints.end());
    optimizer.Optimize(&graph_);
  }
  UpdateCovariances(&optimizer, size() - 1);
  return removed;
}

}  // namespace loopgrid
