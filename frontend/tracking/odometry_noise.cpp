#include "frontend/tracking/odometry_noise.h"

#include <cmath>

namespace loopgrid {

Eigen::Matrix3d OdometryCovariance(const SE2& motion, const OdometryNoise& noise) {
  const double metres = motion.translation().norm();
  const double radians = std::abs(motion.theta());
  const double translation = noise.translation_floor + noise.translation_per_metre * metres +
                             noise.translation_per_radian * radians;
  const double rotation = noise.rotation_floor + noise.rotation_per_metre * metres +
                          noise.rotation_per_radian * radians;
  return Eigen::Vector3d(translation * translation, translation * translation, rotation * rotation)
      .asDiagonal();
}

}  // namespace loopgrid
