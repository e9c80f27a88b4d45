#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace loopgrid {

/// The rotation R = Rz(yaw) * Ry(pitch) * Rx(roll) of (roll, pitch, yaw), radians.
inline Eigen::Quaterniond FromRollPitchYaw(const Eigen::Vector3d& angles) {
  return Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX());
}

/// (roll, pitch, yaw) of a rotation, pitch in [-pi/2, pi/2], the others in [-pi, pi]. At a pitch of
/// +-pi/2 only the sum or the difference of the two others is determined; roll is 0 there.
inline Eigen::Vector3d RollPitchYaw(const Eigen::Quaterniond& q) {
  const Eigen::Matrix3d R = q.toRotationMatrix();
  const double cos_pitch = std::hypot(R(0, 0), R(1, 0));
  // Near a pitch of +-pi/2 roll has large rounding errors. Yaw is computed from the rotation
  // without this roll, so that the errors cancel.
  const double roll = cos_pitch < 1e-14 ? 0.0 : std::atan2(R(2, 1), R(2, 2));
  const double sr = std::sin(roll);
  const double cr = std::cos(roll);
  return {roll, std::atan2(-R(2, 0), cos_pitch),
          std::atan2(sr * R(0, 2) - cr * R(0, 1), cr * R(1, 1) - sr * R(1, 2))};
}

/// The matrix that takes the rates of (roll, pitch, yaw) to the angular velocity in the body's own
/// frame. Singular where pitch is +-pi/2: gimbal lock.
inline Eigen::Matrix3d BodyRates(const Eigen::Vector3d& angles) {
  const double sr = std::sin(angles.x());
  const double cr = std::cos(angles.x());
  const double sp = std::sin(angles.y());
  const double cp = std::cos(angles.y());
  return (Eigen::Matrix3d() << 1.0, 0.0, -sp, 0.0, cr, sr * cp, 0.0, -sr, cr * cp).finished();
}

}  // namespace loopgrid
