#include "frontend/log/carmen/carmen_format.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace loopgrid {

std::string CarmenPose(const SE2& pose) {
  return fmt::format("{:.6f} {:.6f} {:.6f}", pose.x(), pose.y(), pose.theta());
}

std::string CarmenMountLines(bool front, const SE2& T_robot_laser) {
  return fmt::format(
      "PARAM robot_{0}laser_offset {1:.6f} nohost 0\n"
      "PARAM robot_{0}laser_side_offset {2:.6f} nohost 0\n"
      "PARAM robot_{0}laser_angular_offset {3:.6f} nohost 0\n",
      front ? "front" : "rear", T_robot_laser.x(), T_robot_laser.y(), T_robot_laser.theta());
}

std::string CarmenRobotLaserLine(bool front, const Observation& observation, const SE2& T_map_laser,
                                 double log_time) {
  const LaserScan& scan = observation.scan;
  const std::size_t count = scan.ranges.size();
  const double span = scan.angle_step * (static_cast<double>(count) - 1.0);
  const bool clockwise = scan.angle_step < 0.0;
  std::string line =
      fmt::format("ROBOTLASER{} 0 {:.9f} {:.9f} {:.9f} {:g} 0.01 0 {}", front ? 1 : 2,
                  clockwise ? scan.first_angle + span : scan.first_angle, std::abs(span),
                  std::abs(scan.angle_step), scan.max_range, count);
  for (std::size_t i = 0; i < count; ++i) {
    fmt::format_to(std::back_inserter(line), " {}", scan.ranges[clockwise ? count - 1 - i : i]);
  }
  fmt::format_to(std::back_inserter(line), " 0 {} {} 0 0 0 0 0 {:.6f} nohost {:.6f}\n",
                 CarmenPose(T_map_laser), CarmenPose(observation.T_odom_robot),
                 observation.timestamp, log_time);
  return line;
}

}  // namespace loopgrid
