#include "frontend/evaluation/tum_file.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "backend/base/atomic_file.h"
#include "frontend/log/observation/plausible_pose.h"

namespace loopgrid {
namespace {

double Norm(double qx, double qy, double qz, double qw) {
  return std::hypot(std::hypot(qx, qy), std::hypot(qz, qw));  // does not overflow
}

/// The rotation about the z axis of a unit quaternion, radians.
double Yaw(double qx, double qy, double qz, double qw) {
  return std::atan2(2.0 * (qw * qz + qx * qy), 1.0 - 2.0 * (qy * qy + qz * qz));
}

}  // namespace

bool IsNearUnitQuaternion(double qx, double qy, double qz, double qw) {
  const double norm = Norm(qx, qy, qz, qw);
  return norm >= 0.9 && norm <= 1.1;
}

Trajectory TrajectoryFrom(const NumberTable& table) {
  Trajectory trajectory;
  trajectory.reserve(table.rows.size());
  for (const NumberTable::Row& row : table.rows) {
    const auto& [timestamp, x, y, z, qx, qy, qz, qw] = row.numbers;
    if (!IsPlausiblePose(x, y, 0.0)) throw table.ErrorAt(row, "the pose is out of any bounds");
    const double norm = Norm(qx, qy, qz, qw);
    if (!IsNearUnitQuaternion(qx, qy, qz, qw)) {
      throw table.ErrorAt(row, fmt::format("the quaternion's norm is {:g}, not 1", norm));
    }
    const double yaw = Yaw(qx / norm, qy / norm, qz / norm, qw / norm);
    trajectory.push_back({timestamp, SE2(x, y, yaw)});
  }
  if (trajectory.empty()) throw Error(ErrorCode::kInput, table.path + ": holds no pose");
  return trajectory;
}

Trajectory ReadTumFile(const std::string& path) { return TrajectoryFrom(ReadNumberTable(path)); }

std::string FormatTum(const Trajectory& trajectory) {
  std::string text;
  for (const auto& [timestamp, pose] : trajectory) {
    fmt::format_to(std::back_inserter(text), "{:.6f} {:.6f} {:.6f} 0 0 0 {:.9f} {:.9f}\n",
                   timestamp, pose.x(), pose.y(), std::sin(pose.theta() / 2.0),
                   std::cos(pose.theta() / 2.0));
  }
  return text;
}

void WriteTumFile(const std::string& path, const Trajectory& trajectory) {
  WriteFileAtomically(path, FormatTum(trajectory));
}

}  // namespace loopgrid
