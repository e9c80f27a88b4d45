#include "frontend/closing/delayed_graph.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <utility>

namespace loopgrid {

int DelayedGraph::Add(NewNode node, std::int64_t step) {
  const int index = size();
  if (node.new_session) {
    session_ = index;
    localized_ = false;
  }
  pending_.push_back({index, node.parent, node.T_parent_node, node.covariance, step + kLag});
  Append(pending_.back());
  closing_.Submit(std::move(node));
  return index;
}

// Puts a node at the end of the graph as tracking has it.
void DelayedGraph::Append(const Pending& node) {
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

bool DelayedGraph::TakeDue(std::int64_t step, std::vector<int>* changed) {
  bool moved = false;
  while (!pending_.empty() && pending_.front().due <= step) moved |= TakeOldest(changed);
  return moved;
}

bool DelayedGraph::TakeOldest(std::vector<int>* changed) {
  const bool of_this_session = pending_.front().index >= session_;
  pending_.pop_front();
  ClosingNews news = closing_.Take();
  if (of_this_session) localized_ = news.localized;
  return Apply(std::move(news), changed);
}

bool DelayedGraph::Apply(ClosingNews news, std::vector<int>* changed) {
  closing_seconds_ += news.closing_seconds;
  optimizing_seconds_ += news.optimizing_seconds;
  for (const auto& [index, record] : news.records) {
    const auto place = static_cast<std::size_t>(index);
    if (place >= closures_.size()) closures_.resize(place + 1);
    closures_[place] = record;
    if (record.outcome == ClosureOutcome::kAccepted) {
      newest_closed_ = std::max(newest_closed_, record.to);
    }
    changed->push_back(index);
  }
  if (!news.optimized) return false;
  graph_ = std::move(news.optimized->graph);
  relative_covariances_ = std::move(news.optimized->relative_covariances);
  map_covariances_ = std::move(news.optimized->map_covariances);
  for (const Pending& node : pending_) Append(node);
  return true;
}

void DelayedGraph::Finish() {
  std::vector<int> ignored;
  TakeDue(std::numeric_limits<std::int64_t>::max(), &ignored);
  Apply(closing_.Finish(), &ignored);
}

}  // namespace loopgrid
