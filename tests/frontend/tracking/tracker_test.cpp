#include "frontend/tracking/tracker.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "tests/support/rooms.h"

namespace loopgrid {
namespace {

using test_support::DistinctiveRoom;
using test_support::PortableRandom;
using test_support::ScanFrom;
using test_support::SimulatedLaser;
using test_support::SimulatedRun;
using test_support::SimulationOptions;
using test_support::World;

constexpr double kTrackerDegree = std::numbers::pi / 180.0;

PointScan PointsOf(const Observation& observation) {
  return MakePointScan(observation.scan, 0.05, 30.0);
}

// A tracker that knows the room as seen from `pose`, where the robot is.
Tracker TrackerAt(const SE2& pose) {
  std::vector<PointScan> scans;
  std::vector<PlacedScan> placed;
  for (int i = 0; i < 4; ++i) {
    scans.push_back(ScanFrom(DistinctiveRoom(), pose * SE2(0, 0, 1.5 * i), SimulatedLaser{}, 3));
  }
  for (int i = 0; i < 4; ++i) {
    placed.push_back({&scans[static_cast<std::size_t>(i)], pose * SE2(0, 0, 1.5 * i)});
  }
  Tracker tracker;
  tracker.SetMap(placed, pose);
  return tracker;
}

TEST(Tracker, FollowsARobotWithBadOdometry) {
  const std::vector<Eigen::Vector2d> route = {
      {-3.0, -2.0}, {1.0, -2.2}, {1.0, 1.5}, {-1.0, 1.5}, {-1.0, -1.0}};
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    SimulationOptions options;
    options.seed = seed;
    options.odometry = {.distance_scale = 1.1,
                        .turn_scale = 0.9,
                        .turn_per_metre = 0.06,
                        .distance_noise = 0.03,
                        .turn_noise = 0.03,
                        .turn_noise_turning = 0.05};
    const SimulatedRun run = Simulate(DistinctiveRoom(), route, options);
    std::vector<std::unique_ptr<PointScan>> scans;
    std::vector<PlacedScan> placed;
    Tracker tracker;
    for (std::size_t i = 0; i < run.observations.size(); ++i) {
      scans.push_back(std::make_unique<PointScan>(PointsOf(run.observations[i])));
      if (i == 0) {
        placed.push_back({scans[0].get(), run.true_poses[0]});
        tracker.SetMap(placed, run.true_poses[0]);
        continue;
      }
      const SE2 motion =
          run.observations[i - 1].T_odom_robot.Inverse() * run.observations[i].T_odom_robot;
      const TrackedPose tracked = tracker.Track(*scans[i], motion);
      ASSERT_TRUE(tracked.matched) << i;
      const Eigen::Vector3d error = tracked.T_map_robot.Boxminus(run.true_poses[i]);
      ASSERT_LT(error.head<2>().norm(), 0.05) << i;
      ASSERT_LT(std::abs(error.z()), 1.0 * kTrackerDegree) << i;
      EXPECT_GT(tracked.covariance.diagonal().minCoeff(), 0.0);
      if (i % 3 == 0) {
        placed.push_back({scans[i].get(), tracked.T_map_robot});
        tracker.SetMap(placed, tracked.T_map_robot);
      }
    }
    const SE2 odometry = run.true_poses[0] * run.observations.back().T_odom_robot;
    EXPECT_GT(odometry.Boxminus(run.true_poses.back()).norm(), 0.3);  // it was bad indeed
  }
}

// How many of fifty scans are found where they were taken, after the odometry jumped.
int FoundOfFifty(double metres, double radians) {
  int found = 0;
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    PortableRandom random(seed);
    const SE2 start{random.Uniform(-2.0, 1.0), random.Uniform(-2.0, 0.5), random.Uniform(-3, 3)};
    const SE2 truth = start * SE2(0.1, 0.02, 0.05);
    const double way = random.Uniform(-3.0, 3.0);
    const SE2 jump(metres * std::cos(way), metres * std::sin(way), way > 0.0 ? radians : -radians);
    Tracker tracker = TrackerAt(start);
    const PointScan scan = ScanFrom(DistinctiveRoom(), truth, SimulatedLaser{}, seed);
    const TrackedPose tracked = tracker.Track(scan, start.Inverse() * truth * jump);
    const Eigen::Vector3d error = tracked.T_map_robot.Boxminus(truth);
    const bool right = error.head<2>().norm() < 0.05 && std::abs(error.z()) < kTrackerDegree;
    found += tracked.matched && right ? 1 : 0;
  }
  return found;
}

TEST(Tracker, RecoversFromMostJumpsOfTheOdometry) {
  EXPECT_GE(FoundOfFifty(0.2, 0.0), 47);
  EXPECT_GE(FoundOfFifty(0.5, 0.0), 35);
  EXPECT_GE(FoundOfFifty(0.0, 1.2), 47);
  EXPECT_GE(FoundOfFifty(0.0, 3.0), 42);
}

TEST(Tracker, GoesOnWithTheOdometryWhereItCannotMatch) {
  World other;
  other.AddBox({0.0, 0.0}, {1.1, 0.7}, 0.3);
  const SE2 start(-0.5, -0.5, 0.4);
  const SE2 motion(0.2, -0.1, 0.3);
  Tracker tracker = TrackerAt(start);
  const TrackedPose lost = tracker.Track(ScanFrom(other, SE2()), motion);
  EXPECT_FALSE(lost.matched);
  EXPECT_FALSE(lost.unusable);
  EXPECT_EQ(lost.T_map_robot.coordinates(), (start * motion).coordinates());
  EXPECT_EQ(tracker.pose().coordinates(), (start * motion).coordinates());
  // And matches again as soon as there is something to match.
  const TrackedPose found =
      tracker.Track(ScanFrom(DistinctiveRoom(), start * motion), SE2(0.01, 0.0, 0.0));
  EXPECT_TRUE(found.matched);
  EXPECT_LT(found.T_map_robot.Boxminus(start * motion).norm(), 0.05);
}

TEST(Tracker, CallsAScanOfTooFewHitsUnusable) {
  const SE2 start(-0.5, -0.5, 0.4);
  PointScan scan = ScanFrom(DistinctiveRoom(), start);
  for (std::size_t count : {std::size_t{0}, std::size_t{19}}) {
    scan.hits.resize(count);
    scan.normals.resize(count);
    Tracker tracker = TrackerAt(start);
    const TrackedPose tracked = tracker.Track(scan, SE2(0.1, 0.0, 0.0));
    EXPECT_TRUE(tracked.unusable);
    EXPECT_FALSE(tracked.matched);
    EXPECT_EQ(tracked.T_map_robot.coordinates(), (start * SE2(0.1, 0.0, 0.0)).coordinates());
  }
}

TEST(Tracker, WithoutAMapGoesByTheOdometry) {
  Tracker tracker;
  const PointScan scan = ScanFrom(DistinctiveRoom(), SE2());
  const SE2 motion(0.1, 0.2, 0.3);
  EXPECT_FALSE(tracker.Track(scan, motion).matched);
  EXPECT_EQ(tracker.Track(scan, motion).T_map_robot.coordinates(), (motion * motion).coordinates());
  const PointScan empty;
  const std::array<PlacedScan, 1> placed = {{{&empty, SE2()}}};
  tracker.SetMap(placed, SE2(1.0, 0.0, 0.0));
  EXPECT_FALSE(tracker.Track(scan, motion).matched);
}

TEST(Tracker, StandsStillInTheSamePlace) {
  const SE2 start(-0.5, -0.5, 0.4);
  Tracker tracker = TrackerAt(start);
  for (std::uint32_t seed = 1; seed <= 30; ++seed) {
    const PointScan scan = ScanFrom(DistinctiveRoom(), start, SimulatedLaser{}, seed);
    ASSERT_TRUE(tracker.Track(scan, SE2()).matched);
    ASSERT_LT(tracker.pose().Boxminus(start).norm(), 0.02) << seed;
  }
}

}  // namespace
}  // namespace loopgrid
