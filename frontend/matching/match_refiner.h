#pragma once

#include <Eigen/Core>

#include "backend/geometry/se2.h"
#include "frontend/matching/local_map.h"
#include "frontend/matching/matching_options.h"
#include "frontend/matching/point_scan.h"

namespace loopgrid {

/// The pose that the odometry predicts, with its information.
struct PosePrior {
  SE2 T_map_robot;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< in the robot's own frame
};

struct RefinedMatch {
  SE2 T_map_robot;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the hits alone, robot frame
  double range_sigma = 0.0;   ///< of one hit across the surface, from the options, metres
  int used = 0;               ///< hits that found a surface
  double inlier_share = 0.0;  ///< hits near their surface, of all that have a normal
  double residual = 0.0;      ///< robust root mean square distance to the surfaces, metres
};

/// Continuous maximum near `T_map_robot`: Gauss-Newton on the distances of hits from the surfaces
/// of `map`, measured across the surface (point-to-line), with Geman-McClure weights.
RefinedMatch RefineMatch(const LocalMap& map, const PointScan& scan, const SE2& T_map_robot,
                         const PosePrior& prior, const RefinerOptions& options = {});

}  // namespace loopgrid
