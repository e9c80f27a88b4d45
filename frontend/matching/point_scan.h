#pragma once

#include <Eigen/Core>
#include <vector>

#include "frontend/log/observation/observation.h"
#include "frontend/matching/matching_options.h"

namespace loopgrid {

/// A scan as points of the plane, robot frame, metres, in beam order.
struct PointScan {
  std::vector<Eigen::Vector2f> hits;        ///< where beams ended
  std::vector<Eigen::Vector2f> normals;     ///< unit, towards the laser; (0, 0) where there is none
  std::vector<Eigen::Vector2f> no_returns;  ///< unit directions of beams that met nothing
  SE2 T_robot_laser;

  std::size_t size() const { return hits.size(); }
};

/// Makes points of `scan`. Readings in [min_range, max_range) are hits; readings at or above
/// `max_range` are no-returns; those below `min_range` are left out.
PointScan MakePointScan(const LaserScan& scan, double min_range, double max_range,
                        const NormalOptions& options = {});

}  // namespace loopgrid
