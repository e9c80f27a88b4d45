#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "frontend/closing/closing_options.h"
#include "frontend/closing/closure_finder.h"
#include "frontend/closing/closure_graph.h"
#include "frontend/closing/closure_list.h"
#include "frontend/closing/closure_verifier.h"
#include "frontend/closing/graph_update.h"
#include "frontend/closing/neighbour_linker.h"
#include "frontend/closing/nodes.h"
#include "frontend/closing/session.h"

namespace loopgrid {

/// What happens to a node once tracking has handed it over: it joins the graph, closures are
/// proposed, verified and put into the graph, and the graph is optimised. What that has changed
/// goes back to tracking as a value. Shares nothing with tracking, so that it can run on a thread
/// of its own.
class NodePipeline {
 public:
  explicit NodePipeline(const ClosingOptions& options = {});
  NodePipeline(const NodePipeline&) = delete;
  NodePipeline& operator=(const NodePipeline&) = delete;

  GraphUpdate Add(const NewNode& node);

  /// Ends the run: links overlapping neighbours and optimises.
  GraphUpdate Finish();

 private:
  void Join(const NewNode& node);
  std::vector<ClosureId> FindClosures(double timestamp);
  bool PutIntoGraph(std::span<const ClosureId> verified);
  std::optional<SE2> SessionMotion(std::span<const ClosureId> verified) const;
  void SetOutcomes(std::span<const ClosureId> ids, ClosureOutcome outcome);
  void Report(bool optimized, GraphUpdate* update);

  NeighbourLinkerOptions linker_options_;
  ClosureFinder finder_;
  ClosureVerifier verifier_;
  ClosureGraph graph_;
  ClosureList closures_;
  Session session_;
  Nodes nodes_;
  std::vector<std::shared_ptr<const PointScan>> scans_;
};

}  // namespace loopgrid
