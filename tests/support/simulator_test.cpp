#include "tests/support/simulator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "tests/support/office_world.h"
#include "tests/support/portable_random.h"

namespace loopgrid::test_support {
namespace {

constexpr double kPi = std::numbers::pi;

World Room(bool glass = false) {
  World world;
  world.AddBox({0.0, 0.0}, {6.0, 4.0}, 0.0, glass);
  return world;
}

TEST(PortableRandom, IsTheSpecifiedMersenneTwister) {
  PortableRandom random(std::mt19937::default_seed);
  for (int i = 1; i < 10000; ++i) random.Uniform();
  EXPECT_EQ(random.Uniform(), 4123659995.0 / 4294967296.0);  // the standard's 10,000th number
}

TEST(PortableRandom, NormalHasMeanZeroAndDeviationOne) {
  PortableRandom random(5);
  constexpr int kDraws = 100000;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double draw = random.Normal();
    sum += draw;
    squares += draw * draw;
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 0.01);
  EXPECT_NEAR(squares / kDraws, 1.0, 0.02);
}

TEST(CastRay, MeetsTheFirstWall) {
  World world = Room();
  EXPECT_DOUBLE_EQ(CastRay(world, {0.0, 0.0}, {1.0, 0.0}), 3.0);
  EXPECT_DOUBLE_EQ(CastRay(world, {1.0, 0.5}, {0.0, -1.0}), 2.5);
  EXPECT_NEAR(CastRay(world, {0.0, 0.0}, {std::sqrt(0.5), std::sqrt(0.5)}), 2.0 * std::sqrt(2.0),
              1e-12);
  world.AddBox({1.5, 0.0}, {1.0, 1.0});
  EXPECT_DOUBLE_EQ(CastRay(world, {0.0, 0.0}, {1.0, 0.0}), 1.0);
  EXPECT_DOUBLE_EQ(CastRay(world, {0.0, 0.0}, {-1.0, 0.0}), 3.0);
}

TEST(CastRay, GlassAndTheOpenGiveNothingBack) {
  EXPECT_EQ(CastRay(Room(true), {0.0, 0.0}, {1.0, 0.0}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(CastRay(Room(), {5.0, 0.0}, {1.0, 0.0}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(CastRay({}, {0.0, 0.0}, {1.0, 0.0}), std::numeric_limits<double>::infinity());
}

TEST(SimulateScan, SeesTheRoomFromWhereTheLaserSits) {
  SimulatedLaser laser;
  laser.T_robot_laser = SE2(0.5, 0.0, 0.0);
  laser.range_noise = 0.0;
  PortableRandom random(1);
  // Looking up from (1, 0): the laser is at (1, 0.5), beam 0 points right, beam 90 up.
  const LaserScan scan = SimulateScan(Room(), SE2(1.0, 0.0, 0.5 * kPi), laser, &random);
  ASSERT_EQ(scan.ranges.size(), 180u);
  EXPECT_FLOAT_EQ(scan.ranges[0], 2.0F);
  EXPECT_FLOAT_EQ(scan.ranges[90], 1.5F);
  EXPECT_NEAR(scan.ranges[45], 1.5 * std::sqrt(2.0), 0.005);
}

TEST(SimulateScan, ReadingsAreNoisyMultiplesOfTheQuantum) {
  SimulatedLaser laser;
  laser.beams = 1;
  laser.first_angle = 0.0;
  PortableRandom random(2);
  double squares = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const float range = SimulateScan(Room(), SE2(), laser, &random).ranges[0];
    EXPECT_NEAR(range * 100.0F, std::round(range * 100.0F), 1e-3F);
    squares += (range - 2.8) * (range - 2.8);
  }
  EXPECT_NEAR(std::sqrt(squares / 2000), std::sqrt(0.01 * 0.01 * (1.0 + 1.0 / 12.0)), 0.001);
}

TEST(SimulateScan, WhatDoesNotReturnReadsAsSuch) {
  SimulatedLaser laser;
  laser.usable_range = 2.9;
  PortableRandom random(3);
  const LaserScan scan = SimulateScan(Room(), SE2(-0.2, 0.0, 0.0), laser, &random);
  EXPECT_EQ(scan.ranges[90], 81.83F);
  EXPECT_LT(scan.ranges[0], 2.1F);
}

TEST(Simulate, PerfectWheelsCountTheTrueWay) {
  SimulationOptions options;
  options.odometry = {1.0, 1.0, 0.0, 0.0, 0.0, 0.0};
  const SimulatedRun run = Simulate(OfficeWorld(), OfficeRoute(), options);
  ASSERT_EQ(run.observations.size(), run.true_poses.size());
  for (std::size_t i = 0; i < run.true_poses.size(); ++i) {
    const SE2 way = run.true_poses.front().Inverse() * run.true_poses[i];
    EXPECT_LT(way.Boxminus(run.observations[i].T_odom_robot).norm(), 1e-9);
  }
}

TEST(Simulate, StepsAreAsAskedFor) {
  SimulationOptions options;
  const SimulatedRun run = Simulate(Room(), OfficeRoute(), options);
  for (std::size_t i = 1; i < run.true_poses.size(); ++i) {
    const SE2 step = run.true_poses[i - 1].Inverse() * run.true_poses[i];
    EXPECT_LE(step.translation().norm(), options.distance_between_scans + 1e-9);
    EXPECT_LE(std::abs(step.theta()), options.turn_between_scans + 1e-9);
    EXPECT_GT(run.observations[i].timestamp, run.observations[i - 1].timestamp);
  }
}

TEST(Simulate, SeedsDecide) {
  SimulationOptions options;
  const SimulatedRun a = Simulate(Room(), OfficeRoute(), options);
  const SimulatedRun b = Simulate(Room(), OfficeRoute(), options);
  options.seed = 7;
  const SimulatedRun c = Simulate(Room(), OfficeRoute(), options);
  EXPECT_EQ(a.observations.back().scan.ranges, b.observations.back().scan.ranges);
  EXPECT_EQ(a.observations.back().T_odom_robot.x(), b.observations.back().T_odom_robot.x());
  EXPECT_NE(a.observations.back().T_odom_robot.x(), c.observations.back().T_odom_robot.x());
}

TEST(OfficeRoute, MeetsNoWall) {
  const World world = OfficeWorld();
  const std::vector<Eigen::Vector2d> route = OfficeRoute();
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    const Eigen::Vector2d way = route[i + 1] - route[i];
    const Eigen::Vector2d across = 0.25 * Eigen::Vector2d(-way.y(), way.x()).normalized();
    for (const Eigen::Vector2d& side : {Eigen::Vector2d(across), Eigen::Vector2d(-across)}) {
      EXPECT_GT(CastRay(world, route[i] + side, way.normalized()), way.norm()) << "leg " << i;
    }
  }
}

TEST(OfficeRun, DriftsByMetresUntilTheLoopCloses) {
  const SimulatedRun run = OfficeRun();
  double length = 0.0;
  double largest_error = 0.0;
  for (std::size_t i = 1; i < run.true_poses.size(); ++i) {
    length += (run.true_poses[i].translation() - run.true_poses[i - 1].translation()).norm();
    const SE2 by_wheels = run.true_poses.front() * run.observations[i].T_odom_robot;
    largest_error =
        std::max(largest_error, (by_wheels.translation() - run.true_poses[i].translation()).norm());
  }
  EXPECT_NEAR(length, 150.0, 5.0);
  EXPECT_GT(largest_error, 2.0);
  EXPECT_LT(largest_error, 10.0);
}

}  // namespace
}  // namespace loopgrid::test_support
