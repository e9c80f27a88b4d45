#pragma once

#include <Eigen/Core>

#include "backend/geometry/se2.h"
#include "frontend/matching/local_map.h"
#include "frontend/matching/point_scan.h"

namespace loopgrid {

struct RefinerOptions {
  int max_iterations = 10;
  double first_scale = 0.15;  ///< distance at which a residual starts to lose its say, metres ...
  double last_scale = 0.05;   ///< ... at the end
  double range_sigma = 0.03;  ///< standard deviation of one hit across the surface, metres
  double normal_sigma = 0.1;  ///< standard deviation of a normal's direction, radians
};

/// A pose that the odometry suggests, and how sure it is.
struct PosePrior {
  SE2 T_map_robot;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< in the robot's own frame
};

struct RefinedMatch {
  SE2 T_map_robot;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the hits alone, robot frame
  double range_sigma = 0.0;   ///< of one hit across the surface, as the options had it, metres
  int used = 0;               ///< hits that found a surface
  double inlier_share = 0.0;  ///< hits near their surface, of all that have a normal
  double residual = 0.0;      ///< robust root mean square distance to the surfaces, metres
};

/// Continuous maximum near `T_map_robot`: Gauss-Newton on the distances of hits from the surfaces
/// of `map`, measured across the surface (point-to-line), with Geman-McClure weights.
RefinedMatch RefineMatch(const LocalMap& map, const PointScan& scan, const SE2& T_map_robot,
                         const PosePrior& prior, const RefinerOptions& options = {});

}  // namespace loopgrid
