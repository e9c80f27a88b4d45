#include "tests/apps/small_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "backend/geometry/se2.h"

namespace loopgrid::test_support {
namespace {

constexpr double kHalfLength = 4.0;  // of the room, metres
constexpr double kHalfWidth = 3.0;

/// Distance to the walls of a room around the origin.
double RangeToWall(const Eigen::Vector2d& from, double direction) {
  const auto to_wall = [](double position, double speed, double half) {
    if (speed == 0.0) return std::numeric_limits<double>::infinity();
    return ((speed > 0.0 ? half : -half) - position) / speed;
  };
  return std::min(to_wall(from.x(), std::cos(direction), kHalfLength),
                  to_wall(from.y(), std::sin(direction), kHalfWidth));
}

/// The scan of the robot at `pose` when its odometry is `odometry`.
std::string ScanLine(const SE2& pose, const SE2& odometry, double seconds) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  std::string text = "FLASER 180";
  for (int beam = 0; beam < 180; ++beam) {
    const double range = RangeToWall(pose.translation(), pose.theta() + (beam - 90) * kDegree);
    fmt::format_to(std::back_inserter(text), " {:.3f}", range);
  }
  const std::string place =
      fmt::format("{:.6f} {:.6f} {:.6f}", odometry.x(), odometry.y(), odometry.theta());
  fmt::format_to(std::back_inserter(text), " {} {} {:.6f} host {:.6f}\n", place, place,
                 1000.0 + seconds, seconds);
  return text;
}

}  // namespace

std::string SmallLog(int scans) {
  constexpr double kRadius = 1.5;
  std::string text = "# robot in a room\n";
  for (int i = 0; i < scans; ++i) {
    const double turned = 0.1 * i / kRadius;
    const SE2 pose(kRadius * std::sin(turned), -kRadius * std::cos(turned), turned);
    text += ScanLine(pose, pose, 0.2 * i);
  }
  return text;
}

std::string LongWay() {
  std::string text;
  for (int i = 0; i < 5; ++i) {
    const std::string place = fmt::format("{:.6f} 0.000000 0.000000", 90.0 * i);
    text += "FLASER 180";
    for (int beam = 0; beam < 180; ++beam) text += beam < 20 ? " 3.000" : " 81.900";
    fmt::format_to(std::back_inserter(text), " {} {} {:.6f} host {:.6f}\n", place, place,
                   1000.0 + 90.0 * i, 90.0 * i);
  }
  return text;
}

std::string StrayScan() { return ScanLine(SE2(), SE2(3e5, 0.0, 0.0), 1e4); }

}  // namespace loopgrid::test_support
