#include "frontend/closing/closure_graph.h"

#include <Eigen/LU>
#include <algorithm>
#include <optional>
#include <utility>

#include "backend/solve/marginals.h"
#include "backend/solve/optimizer_options.h"
#include "frontend/tracking/pose_covariance.h"

namespace loopgrid {
namespace {

OptimizerOptions WhileGrowing(const ClosureGraphOptions& options) {
  OptimizerOptions optimizer;
  optimizer.careful_covariances = false;  // the information of matches differs little
  optimizer.loss = options.loss;
  optimizer.max_iterations = options.max_iterations;
  optimizer.relative_decrease = options.relative_decrease;
  optimizer.absolute_decrease = options.absolute_decrease;
  return optimizer;
}

OptimizerOptions AtTheEnd(const ClosureGraphOptions& options) {
  OptimizerOptions optimizer;
  optimizer.careful_covariances = false;
  optimizer.loss = options.loss;
  optimizer.max_iterations = options.last_max_iterations;
  optimizer.relative_decrease = options.last_relative_decrease;
  optimizer.absolute_decrease = options.last_absolute_decrease;
  return optimizer;
}

}  // namespace

ClosureGraph::ClosureGraph(const ClosureGraphOptions& options)
    : options_(options), optimizer_(WhileGrowing(options)) {}

void ClosureGraph::AddConstraint(ClosureId id, const Constraint<SE2>& constraint) {
  graph_.constraints.push_back(constraint);
  ids_.push_back(id);
}

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
  AddConstraint(kNoClosure, {parent, node, T_parent_node, covariance.inverse(), false});
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

std::vector<ClosureConstraint> ClosureGraph::Closures() const {
  std::vector<ClosureConstraint> closures;
  for (std::size_t k = 0; k < ids_.size(); ++k) {
    if (graph_.constraints[k].robust) closures.push_back({ids_[k], graph_.constraints[k]});
  }
  return closures;
}

int ClosureGraph::WorstClosure() const {
  int worst = -1;
  double worst_chi2 = options_.max_chi2;
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

bool ClosureGraph::TryClosures(std::span<const ClosureConstraint> closures,
                               std::vector<ClosureId>* removed) {
  const PoseGraph<SE2> before = graph_;
  const std::vector<ClosureId> ids_before = ids_;
  int old_ones = static_cast<int>(graph_.constraints.size());
  int new_ones = static_cast<int>(closures.size());
  std::vector<ClosureId> contradicted;
  for (const ClosureConstraint& closure : closures) AddConstraint(closure.id, closure.constraint);
  optimizer_.Optimize(&graph_);
  for (int worst = WorstClosure(); worst >= 0; worst = WorstClosure()) {
    // At most as many old closures are removed as new ones stay.
    --(worst < old_ones ? old_ones : new_ones);
    contradicted.push_back(ids_[static_cast<std::size_t>(worst)]);
    const int given_up = static_cast<int>(ids_before.size()) - old_ones;
    if (new_ones == 0 || given_up > new_ones) {
      graph_ = before;
      ids_ = ids_before;
      return false;
    }
    graph_.constraints.erase(graph_.constraints.begin() + worst);
    ids_.erase(ids_.begin() + worst);
    optimizer_.Optimize(&graph_);
  }
  if (removed != nullptr) *removed = std::move(contradicted);
  UpdateCovariances(&optimizer_, size() - 1);
  return true;
}

void ClosureGraph::UpdateCovariances(Optimizer<SE2>* optimizer, int relative_to) {
  if (const std::optional<Marginals<SE2>> marginals = optimizer->ComputeMarginals(graph_)) {
    covariances_ = marginals->RelativeTo(relative_to).nodes;
    map_covariances_ = marginals->covariances();
  }
}

std::vector<ClosureId> ClosureGraph::Settle(std::span<const ClosureConstraint> links) {
  std::vector<ClosureId> removed;
  if (size() == 0) return removed;
  for (const ClosureConstraint& link : links) AddConstraint(link.id, link.constraint);
  Optimizer<SE2> optimizer(AtTheEnd(options_));
  optimizer.Optimize(&graph_);
  for (int worst = WorstClosure(); worst >= 0; worst = WorstClosure()) {
    // A wrong closure raises the chi2 of its neighbours. So only those with the largest values are
    // removed before the graph is optimised again.
    const double worst_chi2 = Chi2(graph_.constraints[static_cast<std::size_t>(worst)]);
    RemoveAbove(std::max(options_.max_chi2, 0.5 * worst_chi2), &removed);
    optimizer.Optimize(&graph_);
  }
  UpdateCovariances(&optimizer, size() - 1);
  return removed;
}

void ClosureGraph::RemoveAbove(double limit, std::vector<ClosureId>* removed) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < ids_.size(); ++k) {
    if (graph_.constraints[k].robust && Chi2(graph_.constraints[k]) > limit) {
      removed->push_back(ids_[k]);
      continue;
    }
    graph_.constraints[kept] = graph_.constraints[k];
    ids_[kept++] = ids_[k];
  }
  graph_.constraints.resize(kept);
  ids_.resize(kept);
}

}  // namespace loopgrid
