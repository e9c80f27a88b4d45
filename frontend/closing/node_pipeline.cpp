#include "frontend/closing/node_pipeline.h"

#include <Eigen/LU>

#include "backend/base/stopwatch.h"

namespace loopgrid {

NodePipeline::NodePipeline(const ClosingOptions& options)
    : linker_options_(options.linker),
      finder_(options.finder),
      verifier_(options.verifier),
      graph_(options.graph) {
  nodes_.graph = &graph_.graph();
}

GraphUpdate NodePipeline::Add(const NewNode& node) {
  GraphUpdate update;
  Join(node);
  std::vector<ClosureId> verified;
  if (node.parent >= 0) {
    const ScopedTimer stopwatch(&update.closing_seconds);
    verified = FindClosures(node.timestamp);
  }
  bool optimized = false;
  if (!verified.empty()) {
    const ScopedTimer stopwatch(&update.optimizing_seconds);
    optimized = PutIntoGraph(verified);
  }
  Report(optimized, &update);
  return update;
}

// Adds the node to the graph with the constraint that tracking measured.
void NodePipeline::Join(const NewNode& node) {
  const int index = nodes_.size();
  const bool first = node.parent < 0;
  const SE2 T_map_node = first ? node.T_parent_node : nodes_.pose(node.parent) * node.T_parent_node;
  graph_.AddNode(T_map_node, node.T_parent_node, node.covariance, node.parent);
  scans_.push_back(node.scan);
  nodes_.scans.push_back(scans_.back().get());
  if (node.parent != index - 1 || node.new_session) nodes_.gaps[index] = node.gap;
  if (node.new_session) {
    verifier_.Expire(&closures_);
    session_ = {.first_node = index, .localized = false};
  }
}

// Proposes closures of the newest node. Returns the closures that are verified now.
std::vector<ClosureId> NodePipeline::FindClosures(double timestamp) {
  bool is_any_pending = false;
  for (const Closure& closure :
       finder_.Propose(nodes_, session_, timestamp, graph_.relative_covariances())) {
    const ClosureId id = closures_.Add(closure);
    if (closure.outcome != ClosureOutcome::kPending) continue;
    verifier_.Add(id);
    is_any_pending = true;
  }
  if (!is_any_pending) return {};
  return verifier_.Verify(nodes_, !session_.localized, &closures_);
}

// Puts the closures into the graph and optimises it. False if the graph refuses them.
bool NodePipeline::PutIntoGraph(std::span<const ClosureId> verified) {
  std::vector<ClosureConstraint> constraints;
  for (const ClosureId id : verified) {
    const Closure& c = closures_[id];
    constraints.push_back({id, {c.from, c.to, c.T_from_to, c.covariance.inverse(), true}});
  }
  // The optimiser has to begin near the optimum, but a session that is not localized can be
  // anywhere.
  const std::optional<SE2> motion = SessionMotion(verified);
  if (motion) graph_.MoveNodes(session_.first_node, *motion);
  std::vector<ClosureId> removed;
  const bool kept = graph_.TryClosures(constraints, &removed);
  if (motion && !kept) graph_.MoveNodes(session_.first_node, motion->Inverse());

  for (const auto& [id, constraint] : constraints) closures_.SetChi2(id, graph_.Chi2(constraint));
  SetOutcomes(verified, kept ? ClosureOutcome::kAccepted : ClosureOutcome::kRejected);
  SetOutcomes(removed, ClosureOutcome::kRejected);
  verifier_.Forget(kept ? std::span<const ClosureId>(removed) : verified);
  if (motion && kept) session_.localized = true;
  return kept;
}

// The motion that moves the nodes of a session that is not localized to where the verified closures
// with the older map put them; nothing if there are no such closures.
std::optional<SE2> NodePipeline::SessionMotion(std::span<const ClosureId> verified) const {
  if (session_.localized) return std::nullopt;
  for (const ClosureId id : verified) {
    const Closure& c = closures_[id];
    if (c.from >= session_.first_node) continue;
    return nodes_.pose(c.from) * c.T_from_to * nodes_.pose(c.to).Inverse();
  }
  return std::nullopt;
}

void NodePipeline::SetOutcomes(std::span<const ClosureId> ids, ClosureOutcome outcome) {
  for (const ClosureId id : ids) {
    if (id != kNoClosure) closures_.SetOutcome(id, outcome);
  }
}

void NodePipeline::Report(bool optimized, GraphUpdate* update) {
  for (const ClosureId id : closures_.TakeChanged()) update->closures.push_back(closures_[id]);
  update->localized = session_.localized;
  if (!optimized) return;
  update->optimized = {graph_.graph(), graph_.relative_covariances(), graph_.map_covariances()};
}

GraphUpdate NodePipeline::Finish() {
  verifier_.Expire(&closures_);
  std::vector<ClosureConstraint> links;
  for (const Constraint<SE2>& link : LinkNeighbours(nodes_, linker_options_)) {
    links.push_back({kNoClosure, link});
  }
  SetOutcomes(graph_.Settle(links), ClosureOutcome::kRejected);
  for (const auto& [id, constraint] : graph_.Closures()) {
    if (id != kNoClosure) closures_.SetChi2(id, graph_.Chi2(constraint));
  }
  GraphUpdate update;
  Report(true, &update);
  return update;
}

}  // namespace loopgrid
