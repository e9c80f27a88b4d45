#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "backend/graph/pose_graph.h"
#include "frontend/closing/closure.h"
#include "frontend/matching/point_scan.h"

namespace loopgrid {

/// A node to be added to the graph.
struct NewNode {
  int parent = -1;  ///< the node that it is joined to; -1: it is the first
  SE2 T_parent_node;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of T_parent_node, in its own frame
  double gap = 0.0;          ///< metres travelled since the node before, if that is not `parent`
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

/// What a new node has changed in the graph.
struct GraphUpdate {
  std::vector<Closure> closures;            ///< those that are new or have changed, by id
  bool localized = true;                    ///< the session's place in the older map is known
  std::optional<OptimizedGraph> optimized;  ///< the graph as it is now, if poses have moved
  double closing_seconds = 0.0;             ///< spent in finding closures
  double optimizing_seconds = 0.0;          ///< spent in optimising the graph
};

}  // namespace loopgrid
