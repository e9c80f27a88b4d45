#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

#include "backend/geometry/se2.h"
#include "mapping/occupancy_grid.h"

namespace loopgrid {

/// uncertainty.png: the 3 sigma ellipses of the nodes' positions relative to the robot's last pose,
/// which is the last node (the tutorial's Fig. 10), over the map. Covariances are in each node's
/// own frame, order (x, y, theta). Those that are not finite or not positive semi-definite are left
/// out. At most 2,400 pixels a side. Throws Error (kUsage) if a pose is not finite, or if the
/// number of covariances is not that of the nodes.
std::string DrawUncertainty(std::span<const SE2> nodes,
                            std::span<const Eigen::Matrix3d> covariances,
                            const OccupancyGrid* backdrop = nullptr);

}  // namespace loopgrid
