#pragma once

#include <Eigen/Core>
#include <vector>

#include "backend/geometry/se2.h"

namespace loopgrid {

/// A measured relative pose between two nodes with its information matrix.
struct Constraint {
  int from = 0;
  int to = 0;
  SE2 T_from_to;  ///< measured pose of `to` in `from`
  Eigen::Matrix3d information =
      Eigen::Matrix3d::Identity();  ///< order (x, y, theta), in `to`'s measured frame
};

/// The graph of the tutorial: poses are nodes, constraints are edges. Plain data.
struct PoseGraph {
  std::vector<SE2> poses;  ///< T_map_node
  std::vector<Constraint> constraints;
};

}  // namespace loopgrid
