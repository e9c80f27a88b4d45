#include "frontend/closing/loop_closing.h"

#include <Eigen/LU>

#include "backend/base/stopwatch.h"
#include "frontend/closing/neighbour_linker.h"

namespace loopgrid {

void LoopClosing::Join(const NewNode& node) {
  const int index = nodes_.size();
  const bool first = node.parent < 0;
  const SE2 T_map_node = first ? node.T_parent_node : nodes_.pose(node.parent) * node.T_parent_node;
  graph_.AddNode(T_map_node, node.T_parent_node, node.covariance, node.parent);
  scans_.push_back(node.scan);
  nodes_.scans.push_back(scans_.back().get());
  if (node.parent != index - 1 || node.new_session) nodes_.gaps[index] = node.gap;
  if (node.new_session) closer_.StartSession(index);
}

// How far the nodes of a session that does not know its place have to move for the believed
// closures with the older map to hold; nothing if there are none.
std::optional<SE2> LoopClosing::SessionMotion(const std::vector<int>& believed) const {
  if (closer_.localized()) return std::nullopt;
  for (int index : believed) {
    const ClosureRecord& r = closer_.records()[static_cast<std::size_t>(index)];
    if (r.from >= closer_.session()) continue;
    return nodes_.pose(r.from) * r.T_from_to * nodes_.pose(r.to).Inverse();
  }
  return std::nullopt;
}

// True if the closures stay in the graph.
bool LoopClosing::Believe(const std::vector<int>& believed) {
  std::vector<Constraint<SE2>> closures;
  for (int index : believed) {
    const ClosureRecord& r = closer_.records()[static_cast<std::size_t>(index)];
    closures.push_back({r.from, r.to, r.T_from_to, r.covariance.inverse(), true});
  }
  // The optimiser has to begin near the truth, and an unplaced session can be anywhere.
  const std::optional<SE2> motion = SessionMotion(believed);
  if (motion) graph_.MoveNodes(closer_.session(), *motion);
  std::vector<Constraint<SE2>> removed;
  const bool kept = graph_.TryClosures(closures, &removed);
  if (motion && !kept) graph_.MoveNodes(closer_.session(), motion->Inverse());
  for (const Constraint<SE2>& c : closures) closer_.SetChi2(c.from, c.to, graph_.Chi2(c));
  closer_.Decide(believed, kept);
  for (const Constraint<SE2>& c : removed) closer_.Reject(c.from, c.to);
  if (motion && kept) closer_.SetLocalized();
  return kept;
}

bool LoopClosing::CloseLoops(double timestamp, ClosingNews* news) {
  std::vector<int> believed;
  {
    const ScopedTimer stopwatch(&news->closing_seconds);
    believed = closer_.Close(nodes_, timestamp, graph_.relative_covariances());
  }
  if (believed.empty()) return false;
  const ScopedTimer stopwatch(&news->optimizing_seconds);
  return Believe(believed);
}

void LoopClosing::Report(bool optimized, ClosingNews* news) {
  for (int index : closer_.TakeChanged()) {
    news->records.emplace_back(index, closer_.records()[static_cast<std::size_t>(index)]);
  }
  news->localized = closer_.localized();
  if (!optimized) return;
  news->optimized = {graph_.graph(), graph_.relative_covariances(), graph_.map_covariances()};
}

ClosingNews LoopClosing::Add(const NewNode& node) {
  Join(node);
  ClosingNews news;
  const bool optimized = node.parent >= 0 && CloseLoops(node.timestamp, &news);
  Report(optimized, &news);
  return news;
}

ClosingNews LoopClosing::Finish() {
  closer_.Finish();
  for (const Constraint<SE2>& c : graph_.Settle(LinkNeighbours(nodes_))) {
    closer_.Reject(c.from, c.to);
  }
  for (const Constraint<SE2>& c : graph_.graph().constraints) {
    if (c.robust) closer_.SetChi2(c.from, c.to, graph_.Chi2(c));
  }
  ClosingNews news;
  Report(true, &news);
  return news;
}

}  // namespace loopgrid
