#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "backend/graph/pose_graph.h"
#include "frontend/closing/closure_graph.h"
#include "frontend/closing/loop_closer.h"
#include "frontend/closing/nodes.h"

namespace loopgrid {

/// A node on its way into the graph.
struct NewNode {
  int parent = -1;  ///< the node that it is joined to; -1: it is the first
  SE2 T_parent_node;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of that, frame of the new node
  double gap = 0.0;          ///< metres travelled since the node before, where that is not `parent`
  bool new_session = false;  ///< the robot may be anywhere in the map
  double timestamp = 0.0;    ///< of its scan, seconds
  std::shared_ptr<const PointScan> scan;
};

/// The graph after an optimisation.
struct OptimizedGraph {
  PoseGraph<SE2> graph;
  std::vector<Eigen::Matrix3d> relative_covariances;  ///< see ClosureGraph
  std::vector<Eigen::Matrix3d> map_covariances;       ///< see ClosureGraph
};

/// What became of a node.
struct ClosingNews {
  std::vector<std::pair<int, ClosureRecord>> records;  ///< new or changed, with their indices
  bool localized = true;                    ///< the session's place in the older map is known
  std::optional<OptimizedGraph> optimized;  ///< the graph as it is now, if poses have moved
  double closing_seconds = 0.0;
  double optimizing_seconds = 0.0;
};

/// What happens to a node once tracking has handed it over: it joins the graph, loops are closed
/// and the graph is optimised. Shares nothing with tracking, so that it can run on a thread of its
/// own.
class LoopClosing {
 public:
  LoopClosing() { nodes_.graph = &graph_.graph(); }
  LoopClosing(const LoopClosing&) = delete;
  LoopClosing& operator=(const LoopClosing&) = delete;

  ClosingNews Add(const NewNode& node);

  /// Ends the run: links overlapping neighbours and optimises.
  ClosingNews Finish();

 private:
  void Join(const NewNode& node);
  bool CloseLoops(double timestamp, ClosingNews* news);
  bool Believe(const std::vector<int>& believed);
  std::optional<SE2> SessionMotion(const std::vector<int>& believed) const;
  void Report(bool optimized, ClosingNews* news);

  ClosureGraph graph_;
  LoopCloser closer_;
  Nodes nodes_;
  std::vector<std::shared_ptr<const PointScan>> scans_;
};

}  // namespace loopgrid
