#pragma once

#include <Eigen/Core>
#include <vector>

#include "backend/graph/pose_graph.h"
#include "frontend/tracking/tracking_options.h"

namespace loopgrid {

/// The nodes before `end`, nearest to `position` first (ties: the older one), at most `count`.
std::vector<int> NearestNodes(const PoseGraph<SE2>& graph, int end, const Eigen::Vector2d& position,
                              int count);

/// Number of old nodes, counted from the first one. A node is old if it is not among the newest and
/// not within the latest metres of travel. All nodes before node `session`, the first of the
/// session, are old.
int NodesBehind(const PoseGraph<SE2>& graph, int session, const KnownSpaceOptions& options);

/// Whether the map is known at `position`: among the nodes before `end`, either one of an earlier
/// session (before node `session`) is near, or nodes of enough passes are.
bool IsKnown(const PoseGraph<SE2>& graph, int end, int session, const Eigen::Vector2d& position,
             const KnownSpaceOptions& options);

}  // namespace loopgrid
