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

/// What one scan has changed. The mapping thread passes it to the live map, the page and the
/// events.
struct OnlineUpdate {
  TrackedScan tracked;
  std::int64_t line = 0;                    ///< line of the journal with the scan, from 1
  double timestamp = 0.0;                   ///< of the scan, as in the log, seconds
  double latency_seconds = 0.0;             ///< from the arrival of its line to its pose
  ScanPlace place;                          ///< of the scan
  std::shared_ptr<const PointScan> points;  ///< null if the scan adds nothing to the map
  std::vector<Closure> closures;            ///< new ones and changed ones
  std::shared_ptr<const NodeStates> nodes;  ///< null if they have not moved
};

}  // namespace loopgrid
