#include "frontend/tracking/odometry_noise.h"

#include <cmath>

namespace loopgrid {

Eigen::Matrix3d OdometryNoise::Covariance(const SE2& motion) const {
  const double metres = motion.translation().norm();
  const double radians = std::abs(motion.theta());
  const double translation =
      translation_floor + translation_per_metre * metres + translation_per_radian * radians;
  const double rotation =
      rotation_floor + rotation_per_metre * metres + rotation_per_radian * radians;
  return Eigen::Vector3d(translation * translation, translation * translation, rotation * rotation)
      .asDiagonal();
}

}  // namespace loopgrid
