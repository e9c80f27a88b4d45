#include "frontend/evaluation/tum_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>

#include "backend/base/atomic_file.h"
#include "backend/base/line_reader.h"
#include "frontend/evaluation/number_lines.h"
#include "frontend/log/observation/plausible_pose.h"

namespace loopgrid {
namespace {

/// The rotation about the z axis of a unit quaternion, radians.
double Yaw(double qx, double qy, double qz, double qw) {
  return std::atan2(2.0 * (qw * qz + qx * qy), 1.0 - 2.0 * (qy * qy + qz * qz));
}

}  // namespace

Trajectory ReadTumFile(const std::string& path) {
  constexpr double kUnit = 1e-2;  // how far from 1 a rounded quaternion's norm may be
  Trajectory trajectory;
  LineReader lines(path);
  std::array<double, 8> fields{};
  while (NextNumberLine(&lines, fields)) {
    const auto& [timestamp, x, y, z, qx, qy, qz, qw] = fields;
    if (!IsPlausiblePose(x, y, 0.0)) throw lines.ErrorHere("the pose is out of any bounds");
    const double norm = std::hypot(std::hypot(qx, qy), std::hypot(qz, qw));
    if (std::abs(norm - 1.0) > kUnit) {
      throw lines.ErrorHere(fmt::format("the quaternion's norm is {:g}, not 1", norm));
    }
    const double yaw = Yaw(qx / norm, qy / norm, qz / norm, qw / norm);
    trajectory.push_back({timestamp, SE2(x, y, yaw)});
  }
  if (trajectory.empty()) throw Error(ErrorCode::kInput, path + ": holds no pose");
  return trajectory;
}

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
