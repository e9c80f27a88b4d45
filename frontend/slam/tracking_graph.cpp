#include "frontend/slam/tracking_graph.h"

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "frontend/tracking/pose_covariance.h"

namespace loopgrid {

int TrackingGraph::Add(const NewNode& node, std::int64_t step) {
  const int index = size();
  if (node.new_session) session_ = {.first_node = index, .localized = false};
  waiting_.push_back({index, node.parent, node.T_parent_node, node.covariance, step + lag_});
  Append(waiting_.back());
  return index;
}

// Adds a node at the pose that tracking found.
void TrackingGraph::Append(const Waiting& node) {
  if (node.parent < 0) {
    graph_.poses.push_back(node.T_parent_node);
    map_covariances_.push_back(Eigen::Matrix3d::Zero());
    return;
  }
  graph_.poses.push_back(pose(node.parent) * node.T_parent_node);
  graph_.constraints.push_back(
      {node.parent, node.index, node.T_parent_node, node.covariance.inverse(), false});
  map_covariances_.push_back(
      ComposeCovariances(covariance(node.parent), node.T_parent_node, node.covariance));
}

bool TrackingGraph::ApplyOldest(GraphUpdate update, std::vector<ClosureId>* changed) {
  // Updates of nodes before the session say nothing about the session's place.
  if (waiting_.front().index >= session_.first_node) session_.localized = update.localized;
  waiting_.pop_front();
  return Apply(std::move(update), changed);
}

void TrackingGraph::ApplyLast(GraphUpdate update) {
  std::vector<ClosureId> ignored;
  Apply(std::move(update), &ignored);
}

bool TrackingGraph::Apply(GraphUpdate update, std::vector<ClosureId>* changed) {
  closing_seconds_ += update.closing_seconds;
  optimizing_seconds_ += update.optimizing_seconds;
  for (const Closure& closure : update.closures) {
    const auto place = static_cast<std::size_t>(closure.id);
    if (place >= closures_.size()) closures_.resize(place + 1);
    closures_[place] = closure;
    if (closure.outcome == ClosureOutcome::kAccepted) {
      newest_closed_ = std::max(newest_closed_, closure.to);
    }
    changed->push_back(closure.id);
  }
  if (!update.optimized) return false;
  graph_ = std::move(update.optimized->graph);
  relative_covariances_ = std::move(update.optimized->relative_covariances);
  map_covariances_ = std::move(update.optimized->map_covariances);
  for (const Waiting& node : waiting_) Append(node);
  return true;
}

}  // namespace loopgrid
