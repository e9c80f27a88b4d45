#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "backend/graph/pose_graph.h"
#include "frontend/matching/local_map.h"

namespace loopgrid {

/// Consecutive nodes, both ends included.
struct NodeRange {
  int first = 0;
  int last = 0;
};

/// The nodes of the graph with the scan of each.
struct Nodes {
  const PoseGraph<SE2>* graph = nullptr;
  std::vector<const PointScan*> scans;
  /// For nodes without a constraint from the node before: the metres travelled since that node.
  std::map<int, double> gaps;

  int size() const { return static_cast<int>(scans.size()); }
  const SE2& pose(int node) const { return graph->poses[static_cast<std::size_t>(node)]; }
  const PointScan& scan(int node) const { return *scans[static_cast<std::size_t>(node)]; }

  /// Pose of `b` in the frame of `a`.
  SE2 Between(int a, int b) const { return pose(a).Inverse() * pose(b); }

  /// Length of the path from `node` to the next one, metres.
  double StepLength(int node) const;

  /// Length of the path along the nodes from `a` to `b`, metres.
  double PathLength(int a, int b) const;

  /// The nodes within `path` metres of travel before and after `node`.
  NodeRange Around(int node, double path) const;

  /// Surfaces seen from the nodes of `range`, in the frame of node `origin`; those farther from it
  /// than `radius` metres are left out.
  LocalMap MapOf(const NodeRange& range, int origin, double radius) const;
};

}  // namespace loopgrid
