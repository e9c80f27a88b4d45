#pragma once

#include <Eigen/Core>

#include "backend/geometry/se2.h"

namespace loopgrid {

/// How far wheel odometry is trusted: standard deviations of one motion.
struct OdometryNoise {
  double translation_per_metre = 0.15;   ///< metres for a metre travelled
  double translation_per_radian = 0.05;  ///< metres for a radian turned
  double rotation_per_metre = 0.06;      ///< radians for a metre travelled
  double rotation_per_radian = 0.15;     ///< radians for a radian turned
  double translation_floor = 0.01;       ///< metres, of any motion
  double rotation_floor = 0.01;          ///< radians, of any motion

  /// Covariance of a motion, in the frame of its end, order (x, y, theta).
  Eigen::Matrix3d Covariance(const SE2& motion) const;
};

}  // namespace loopgrid
