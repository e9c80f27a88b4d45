#include "tests/support/carmen_text.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace loopgrid::test_support {
namespace {

std::string PoseText(const SE2& pose) {
  return fmt::format("{:.6f} {:.6f} {:.6f}", pose.x(), pose.y(), pose.theta());
}

std::string RangesText(const LaserScan& scan) {
  std::string text = fmt::format("{}", scan.ranges.size());
  for (float range : scan.ranges) text += fmt::format(" {:.2f}", range);
  return text;
}

std::string OdomLine(const Observation& observation) {
  return fmt::format("ODOM {} 0 0 0 {:.6f} simulator {:.6f}\n", PoseText(observation.T_odom_robot),
                     observation.timestamp, observation.timestamp);
}

std::string FlaserLine(const Observation& observation) {
  const SE2 T_odom_laser = observation.T_odom_robot * observation.scan.T_robot_laser;
  return fmt::format("FLASER {} {} {} {:.6f} simulator {:.6f}\n", RangesText(observation.scan),
                     PoseText(T_odom_laser), PoseText(observation.T_odom_robot),
                     observation.timestamp, observation.timestamp);
}

std::string RobotLaserLine(const Observation& observation) {
  const LaserScan& scan = observation.scan;
  const SE2 T_odom_laser = observation.T_odom_robot * scan.T_robot_laser;
  const double field_of_view = scan.angle_step * static_cast<double>(scan.ranges.size() - 1);
  return fmt::format(
      "ROBOTLASER1 0 {:.6f} {:.6f} {:.6f} 50.0 0.01 0 {} 0 {} {} 0 0 0 0 0 {:.6f} simulator "
      "{:.6f}\n",
      scan.first_angle, field_of_view, scan.angle_step, RangesText(scan), PoseText(T_odom_laser),
      PoseText(observation.T_odom_robot), observation.timestamp, observation.timestamp);
}

}  // namespace

std::string CarmenText(const SimulatedRun& run, CarmenDialect dialect) {
  std::string text = "# Made by loopgrid's simulator: not a recording of a robot.\n";
  if (!run.observations.empty()) {
    const LaserScan& scan = run.observations.front().scan;
    text +=
        fmt::format("PARAM robot_frontlaser_offset {:.3f} simulator 0\n", scan.T_robot_laser.x());
    text += fmt::format("PARAM laser_front_laser_resolution {:.3f} simulator 0\n",
                        scan.angle_step * 180.0 / std::numbers::pi);
  }
  for (const Observation& observation : run.observations) {
    text += OdomLine(observation);
    text +=
        dialect == CarmenDialect::kFlaser ? FlaserLine(observation) : RobotLaserLine(observation);
  }
  return text;
}

std::string TrueTrajectoryText(const SimulatedRun& run) {
  std::string text = "# time x y z qx qy qz qw\n";
  for (std::size_t i = 0; i < run.true_poses.size(); ++i) {
    const SE2& pose = run.true_poses[i];
    text +=
        fmt::format("{:.6f} {:.6f} {:.6f} 0 0 0 {:.9f} {:.9f}\n", run.observations[i].timestamp,
                    pose.x(), pose.y(), std::sin(0.5 * pose.theta()), std::cos(0.5 * pose.theta()));
  }
  return text;
}

}  // namespace loopgrid::test_support
