#include "tests/support/simulator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace loopgrid::test_support {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The true poses of all scans: where each step of the route ends.
std::vector<SE2> DriveRoute(std::span<const Eigen::Vector2d> route,
                            const SimulationOptions& options) {
  std::vector<SE2> poses;
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    const Eigen::Vector2d way = route[i + 1] - route[i];
    const double heading = std::atan2(way.y(), way.x());
    if (poses.empty()) poses.emplace_back(route[i].x(), route[i].y(), heading);
    const SE2 before = poses.back();
    const double turn = NormalizeAngle(heading - before.theta());
    const int turns = static_cast<int>(std::ceil(std::abs(turn) / options.turn_between_scans));
    for (int k = 1; k <= turns; ++k) {
      poses.emplace_back(before.x(), before.y(), before.theta() + turn * k / turns);
    }
    const int steps = static_cast<int>(std::ceil(way.norm() / options.distance_between_scans));
    for (int k = 1; k <= steps; ++k) {
      const Eigen::Vector2d place = route[i] + way * (static_cast<double>(k) / steps);
      poses.emplace_back(place.x(), place.y(), heading);
    }
  }
  return poses;
}

// The motion that odometry measures for a true motion between two scans.
SE2 Measure(const SE2& motion, const SimulatedOdometry& odometry, PortableRandom* random) {
  const double distance = motion.translation().norm();
  const double turn = motion.theta();
  const double slip = odometry.distance_noise * std::sqrt(distance) * random->Normal();
  const double sway = odometry.turn_noise * std::sqrt(distance) * random->Normal();
  const double twist = odometry.turn_noise_turning * std::sqrt(std::abs(turn)) * random->Normal();
  const double scale = odometry.distance_scale + (distance > 0.0 ? slip / distance : 0.0);
  return {scale * motion.x(), scale * motion.y(),
          odometry.turn_scale * turn + odometry.turn_per_metre * distance + sway + twist};
}

}  // namespace

void World::AddPolygon(std::span<const Eigen::Vector2d> corners, bool glass) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    walls.push_back({corners[i], corners[(i + 1) % corners.size()], glass});
  }
}

void World::AddBox(const Eigen::Vector2d& centre, const Eigen::Vector2d& size, double angle,
                   bool glass) {
  const SE2 T_world_box(centre.x(), centre.y(), angle);
  const Eigen::Vector2d half = 0.5 * size;
  const std::array<Eigen::Vector2d, 4> corners = {
      T_world_box * Eigen::Vector2d(-half.x(), -half.y()),
      T_world_box * Eigen::Vector2d(half.x(), -half.y()), T_world_box * half,
      T_world_box * Eigen::Vector2d(-half.x(), half.y())};
  AddPolygon(corners, glass);
}

double CastRay(const World& world, const Eigen::Vector2d& origin,
               const Eigen::Vector2d& direction) {
  // Plain numbers instead of vectors, which are slow under sanitizers: this code runs tens of
  // millions of times.
  const double dx = direction.x();
  const double dy = direction.y();
  double nearest = kInfinity;
  bool is_glass = false;
  for (const Wall& wall : world.walls) {
    // origin + t * direction = wall.from + s * along, solved for t and s by cross products.
    const double from_x = wall.from.x() - origin.x();
    const double from_y = wall.from.y() - origin.y();
    const double side_of_from = dx * from_y - dy * from_x;
    const double along_x = wall.to.x() - wall.from.x();
    const double along_y = wall.to.y() - wall.from.y();
    const double determinant = dx * along_y - dy * along_x;
    const double s = -side_of_from / determinant;
    if (!(s >= 0.0 && s <= 1.0)) continue;  // also refuses NaN, if the wall is parallel
    const double t = (from_x * along_y - from_y * along_x) / determinant;
    if (t <= 0.0 || t >= nearest) continue;
    nearest = t;
    is_glass = wall.glass;
  }
  return is_glass ? kInfinity : nearest;
}

LaserScan SimulateScan(const World& world, const SE2& T_world_robot, const SimulatedLaser& laser,
                       PortableRandom* random) {
  LaserScan scan;
  scan.T_robot_laser = laser.T_robot_laser;
  scan.first_angle = laser.first_angle;
  scan.angle_step = laser.angle_step;
  const SE2 T_world_laser = T_world_robot * laser.T_robot_laser;
  for (int i = 0; i < laser.beams; ++i) {
    const double angle = T_world_laser.theta() + laser.first_angle + i * laser.angle_step;
    const double distance =
        CastRay(world, T_world_laser.translation(), {std::cos(angle), std::sin(angle)});
    // Noise is drawn for every beam, so that an additional wall changes only the beams that hit it.
    const double noisy = distance + laser.range_noise * random->Normal();
    const bool returns = distance <= laser.usable_range;
    const double quanta = std::max(0.0, std::round(noisy / laser.quantum));
    scan.ranges.push_back(static_cast<float>(returns ? quanta * laser.quantum : laser.no_return));
  }
  return scan;
}

SimulatedRun Simulate(const World& world, std::span<const Eigen::Vector2d> route,
                      const SimulationOptions& options) {
  SimulatedRun run;
  run.true_poses = DriveRoute(route, options);
  PortableRandom laser_random(options.seed);
  PortableRandom wheel_random(options.seed + 1);
  SE2 T_odom_robot;
  for (std::size_t i = 0; i < run.true_poses.size(); ++i) {
    const SE2& pose = run.true_poses[i];
    if (i > 0) {
      const SE2 motion = run.true_poses[i - 1].Inverse() * pose;
      T_odom_robot = T_odom_robot * Measure(motion, options.odometry, &wheel_random);
    }
    run.observations.push_back(
        {.timestamp = options.seconds_between_scans * static_cast<double>(i + 1),
         .T_odom_robot = T_odom_robot,
         .scan = SimulateScan(world, pose, options.laser, &laser_random)});
  }
  return run;
}

}  // namespace loopgrid::test_support
