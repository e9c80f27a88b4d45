#pragma once

#include <vector>

#include <Eigen/Core>

#include "backend/graph/pose_graph.h"

namespace loopgrid {

struct KnownSpaceOptions {
  double distance = 1.0;           ///< nodes this near make a place known, metres
  int passes = 3;                  ///< ... if they are of so many passes, or of an earlier session
  int same_pass = 10;              ///< nodes this close along the path are of one pass
  int recent_nodes = 20;           ///< the newest nodes say nothing: the robot is still there
  double recent_path = 10.0;       ///< ... nor do those less than this much travel ago, metres
  int closed_within = 10;          ///< one of so many newest nodes must have closed a loop
  int map_nodes = 30;              ///< the nearest nodes that scans are matched with
  double min_inlier_share = 0.75;  ///< of a scan, to be explained by them, 0..1
  double max_shift = 0.15;  ///< between where the graph and where they see the robot, metres ...
  double max_turn = 0.05;   ///< ... and radians
};

/// The nodes before `end`, nearest to `position` first (ties: the older one), at most `count`.
std::vector<int> NearestNodes(const PoseGraph<SE2>& graph, int end, const Eigen::Vector2d& position,
                              int count);

/// How many of the nodes, from the first one on, the robot has left behind it; all those before the
/// session that begins with node `session` are.
int NodesBehind(const PoseGraph<SE2>& graph, int session, const KnownSpaceOptions& options);

/// Whether the map is known at `position`: of the nodes before `end`, some of an earlier session
/// than the one that begins with node `session` are near, or those of enough passes.
bool IsKnown(const PoseGraph<SE2>& graph, int end, int session, const Eigen::Vector2d& position,
             const KnownSpaceOptions& options);

}  // namespace loopgrid
