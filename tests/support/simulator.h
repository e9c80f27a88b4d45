#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "frontend/log/observation/observation.h"
#include "tests/support/portable_random.h"

namespace loopgrid::test_support {

/// A straight piece of wall as seen by a laser in its plane, metres.
struct Wall {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
  bool glass = false;  ///< beams do not return from it
};

struct World {
  std::vector<Wall> walls;

  /// Adds the outline of a polygon.
  void AddPolygon(std::span<const Eigen::Vector2d> corners, bool glass = false);

  /// Adds a box of the given size, turned by `angle` about its centre.
  void AddBox(const Eigen::Vector2d& centre, const Eigen::Vector2d& size, double angle = 0.0,
              bool glass = false);
};

/// A SICK LMS 200 on a robot, by default.
struct SimulatedLaser {
  SE2 T_robot_laser{0.2, 0.0, 0.0};
  int beams = 180;
  double first_angle = -0.5 * std::numbers::pi;
  double angle_step = std::numbers::pi / 180.0;
  double range_noise = 0.01;   ///< standard deviation, metres
  double quantum = 0.01;       ///< readings are whole multiples of this, metres
  double usable_range = 30.0;  ///< beyond it a beam does not return
  double no_return = 81.83;    ///< the reading of such a beam
};

/// Wheel odometry that slips and has a bias.
struct SimulatedOdometry {
  double distance_scale = 1.01;      ///< metres counted per metre driven
  double turn_scale = 0.99;          ///< radians counted per radian turned
  double turn_per_metre = 0.004;     ///< bias of uneven wheels, radians
  double distance_noise = 0.01;      ///< metres per square root of metres driven
  double turn_noise = 0.01;          ///< radians per square root of metres driven
  double turn_noise_turning = 0.02;  ///< radians per square root of radians turned
};

struct SimulationOptions {
  std::uint32_t seed = 1;
  double distance_between_scans = 0.2;  ///< metres
  double turn_between_scans = 0.25;     ///< radians, when turning in place
  double seconds_between_scans = 0.4;
  SimulatedLaser laser;
  SimulatedOdometry odometry;
};

/// The recording of a robot, and its true poses.
struct SimulatedRun {
  std::vector<Observation> observations;
  std::vector<SE2> true_poses;  ///< T_world_robot of each observation
};

/// The distance from `origin` along `direction` (a unit vector) to the first wall, metres: infinite
/// if there is none or if it is glass.
double CastRay(const World& world, const Eigen::Vector2d& origin, const Eigen::Vector2d& direction);

/// One scan from `T_world_robot`, with noise.
LaserScan SimulateScan(const World& world, const SE2& T_world_robot, const SimulatedLaser& laser,
                       PortableRandom* random);

/// Drives from waypoint to waypoint, turns in place at each, and scans on the path. Odometry starts
/// at the origin; the true pose starts at the first waypoint and looks at the second. The same
/// arguments give the same run.
SimulatedRun Simulate(const World& world, std::span<const Eigen::Vector2d> route,
                      const SimulationOptions& options = {});

}  // namespace loopgrid::test_support
