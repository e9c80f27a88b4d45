#pragma once

#include <array>
#include <numbers>
#include <span>
#include <vector>

#include "frontend/matching/local_map.h"
#include "frontend/matching/point_scan.h"
#include "tests/support/simulator.h"

namespace loopgrid::test_support {

/// A room of about 9 m x 7 m that looks different from every pose: all walls differ, and there are
/// a box and a turned cupboard.
inline World DistinctiveRoom() {
  World world;
  const std::array<Eigen::Vector2d, 8> outline = {Eigen::Vector2d(-4.0, -3.0),
                                                  {5.0, -3.0},
                                                  {5.0, 1.0},
                                                  {3.5, 1.0},
                                                  {3.5, 3.5},
                                                  {-1.0, 4.0},
                                                  {-1.0, 3.0},
                                                  {-4.0, 2.4}};
  world.AddPolygon(outline);
  world.AddBox({2.6, -1.6}, {0.9, 0.6});
  world.AddBox({-2.6, 1.0}, {1.1, 0.5}, 0.5);
  return world;
}

/// Two parallel walls along x, `width` metres apart and too long for their ends to be seen.
inline World BareCorridor(double width = 2.0) {
  World world;
  world.walls.push_back({{-200.0, 0.5 * width}, {200.0, 0.5 * width}});
  world.walls.push_back({{-200.0, -0.5 * width}, {200.0, -0.5 * width}});
  return world;
}

/// A laser at the robot's centre with a field of view of 360 degrees and without noise.
inline SimulatedLaser ExactLaser(int beams = 720) {
  SimulatedLaser laser;
  laser.T_robot_laser = SE2();
  laser.beams = beams;
  laser.first_angle = -std::numbers::pi;
  laser.angle_step = 2.0 * std::numbers::pi / beams;
  laser.range_noise = 0.0;
  laser.quantum = 1e-6;
  return laser;
}

/// What `laser` sees from `T_world_robot`.
inline PointScan ScanFrom(const World& world, const SE2& T_world_robot,
                          const SimulatedLaser& laser = ExactLaser(), std::uint32_t seed = 1) {
  PortableRandom random(seed);
  return MakePointScan(SimulateScan(world, T_world_robot, laser, &random), 0.05,
                       laser.usable_range);
}

/// The surfaces seen from `poses`, in the world's frame.
inline LocalMap MapFrom(const World& world, std::span<const SE2> poses,
                        const SimulatedLaser& laser = ExactLaser(), double radius = 30.0) {
  std::vector<PointScan> scans;
  for (const SE2& pose : poses) {
    const auto seed = static_cast<std::uint32_t>(1000 + scans.size());
    scans.push_back(ScanFrom(world, pose, laser, seed));
  }
  std::vector<PlacedScan> placed;
  for (std::size_t i = 0; i < poses.size(); ++i) placed.push_back({&scans[i], poses[i]});
  return LocalMap(placed, poses.front().translation(), radius);
}

}  // namespace loopgrid::test_support
