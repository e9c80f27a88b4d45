#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "frontend/closing/closure.h"
#include "frontend/matching/point_scan.h"
#include "frontend/slam/slam.h"

namespace loopgrid {

/// All nodes of the graph at one moment.
struct NodeStates {
  std::vector<SE2> poses;                    ///< T_map_node
  std::vector<Eigen::Matrix3d> covariances;  ///< as Slam::NodeCovariances(); may be fewer
};

/// What one scan has changed, as values: what the mapping thread hands to all that show or write.
struct OnlineUpdate {
  TrackedScan tracked;
  std::int64_t line = 0;                    ///< of the journal, from 1: where the scan stands
  double timestamp = 0.0;                   ///< of the scan, as in the log, seconds
  double latency_seconds = 0.0;             ///< from the arrival of its line to its pose
  ScanPlace place;                          ///< of the scan
  std::shared_ptr<const PointScan> points;  ///< null if the scan adds nothing to the map
  std::vector<Closure> closures;      ///< new ones and changed ones
  std::shared_ptr<const NodeStates> nodes;  ///< where tracked.optimized: they have moved
};

}  // namespace loopgrid
