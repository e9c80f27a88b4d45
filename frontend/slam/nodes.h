#pragma once

#include <Eigen/Core>
#include <vector>

#include "backend/pose_graph.h"
#include "frontend/matching/local_map.h"

namespace loopgrid {

/// The nodes as the front-end sees them: a graph, and the scan that each node holds.
struct Nodes {
  const PoseGraph* graph = nullptr;
  std::vector<const PointScan*> scans;

  int size() const { return static_cast<int>(scans.size()); }
  const SE2& pose(int node) const { return graph->poses[static_cast<std::size_t>(node)]; }
  const PointScan& scan(int node) const { return *scans[static_cast<std::size_t>(node)]; }

  /// Pose of `b` in the frame of `a`.
  SE2 Between(int a, int b) const { return pose(a).Inverse() * pose(b); }

  /// Length of the path along the nodes from `a` to `b`, metres.
  double PathLength(int a, int b) const;

  /// Surfaces seen from nodes [first, last], in the frame of node `origin`.
  LocalMap MapOf(int first, int last, int origin, double radius) const;
};

}  // namespace loopgrid
