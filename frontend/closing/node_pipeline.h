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

/// Processes a new node after tracking: adds it to the graph, proposes closures, verifies them,
/// puts them into the graph and optimises it. Returns what has changed as a value. It shares no
/// data with tracking, so it can run on a thread of its own.
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
