// Robots that drive in known space, that are carried, or that continue an old map.

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "frontend/slam/slam.h"
#include "tests/support/index.h"
#include "tests/support/rooms.h"

namespace loopgrid {
namespace {

using test_support::DistinctiveRoom;
using test_support::Index;
using test_support::SimulatedRun;
using test_support::World;

SimulatedRun RoundsIn(const World& world, int rounds, std::uint32_t seed = 1) {
  std::vector<Eigen::Vector2d> route;
  for (int round = 0; round < rounds; ++round) {
    for (const Eigen::Vector2d& corner :
         {Eigen::Vector2d(-1.3, -1.3), {1.6, -1.2}, {1.5, 1.5}, {-1.2, 1.4}}) {
      route.push_back(corner);
    }
  }
  test_support::SimulationOptions options;
  options.seed = seed;
  return test_support::Simulate(world, route, options);
}

// The error of each pose, relative to the first pose of the map.
std::vector<double> Errors(const SE2& T_world_map, const std::vector<SE2>& poses,
                           const std::vector<SE2>& truth) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    errors.push_back((T_world_map * poses[i]).Boxminus(truth[i]).norm());
  }
  return errors;
}

TEST(SlamInKnownSpace, AddsNoMoreNodesWhereItHasBeenThreeTimes) {
  const SimulatedRun run = RoundsIn(DistinctiveRoom(), 12);
  Slam slam;
  std::vector<int> nodes;
  for (const Observation& observation : run.observations) {
    slam.AddScan(observation);
    nodes.push_back(static_cast<int>(slam.graph().poses.size()));
  }
  slam.Finish();
  EXPECT_GT(slam.statistics().known_scans, slam.scan_count() / 2);
  EXPECT_EQ(nodes.back(), nodes[nodes.size() / 2]);  // the last six rounds add none
  // Scans without nodes have poses as good as the others, and their points are not kept.
  const std::vector<double> errors = Errors(run.true_poses[0], slam.ScanPoses(), run.true_poses);
  EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 0.06);
  const int last = slam.scan_count() - 1;
  EXPECT_EQ(slam.scan_points(last), nullptr);
  EXPECT_TRUE(slam.scan_hits(last).empty());
  EXPECT_EQ(slam.scan_laser(last).x(), run.observations.back().scan.T_robot_laser.x());
}

TEST(SlamInKnownSpace, AddsNodesAgainWhereTheMapEnds) {
  // Many rounds in one corner of an office-like world, then on into the rest of it.
  World world = DistinctiveRoom();
  world.AddBox({0.0, 0.0}, {40.0, 40.0});
  std::vector<Eigen::Vector2d> route;
  for (int round = 0; round < 6; ++round) {
    for (const Eigen::Vector2d& corner :
         {Eigen::Vector2d(6.0, -8.0), {9.0, -8.0}, {9.0, -5.0}, {6.0, -5.0}}) {
      route.push_back(corner);
    }
  }
  route.push_back({6.0, -8.0});
  const std::size_t corners = route.size();
  for (const Eigen::Vector2d& corner : {Eigen::Vector2d(-8.0, -8.0), {-8.0, 8.0}}) {
    route.push_back(corner);
  }
  const SimulatedRun run = test_support::Simulate(world, route);
  const std::size_t leaves =
      test_support::Simulate(
          world, std::vector(route.begin(), route.begin() + static_cast<std::ptrdiff_t>(corners)))
          .observations.size();
  Slam slam;
  std::size_t nodes_then = 0;
  for (std::size_t i = 0; i < run.observations.size(); ++i) {
    if (i == leaves) nodes_then = slam.graph().poses.size();
    slam.AddScan(run.observations[i]);
  }
  EXPECT_GT(slam.statistics().known_scans, 0);
  EXPECT_GE(slam.graph().poses.size(), nodes_then + 40);  // 30 m
  slam.Finish();
  const std::vector<double> errors = Errors(run.true_poses[0], slam.ScanPoses(), run.true_poses);
  EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 0.3);
}

// A second run in the map of the first. Its first observation says so, or its odometry jumps.
class SlamInAnOldMap : public ::testing::TestWithParam<bool> {};

TEST_P(SlamInAnOldMap, FindsItselfAndAddsNextToNothing) {
  const bool is_told = GetParam();
  const SimulatedRun first = RoundsIn(DistinctiveRoom(), 2);
  const SimulatedRun second = RoundsIn(DistinctiveRoom(), 3, 5);
  Slam slam;
  for (const Observation& observation : first.observations) slam.AddScan(observation);
  const std::size_t nodes_then = slam.graph().poses.size();
  const int scans_then = slam.scan_count();
  // The second run begins elsewhere in the room, with odometry of its own.
  const std::size_t skipped = second.observations.size() / 5;
  std::vector<SE2> truth = first.true_poses;
  int lost = 0;
  for (std::size_t i = skipped; i < second.observations.size(); ++i) {
    Observation observation = second.observations[i];
    observation.new_session = is_told && i == skipped;
    observation.T_odom_robot = SE2(is_told ? 0.3 : 40.0, -0.2, 1.0) * observation.T_odom_robot;
    const TrackedScan tracked = slam.AddScan(observation);
    truth.push_back(second.true_poses[i]);
    if (!tracked.localized) {
      ++lost;
      EXPECT_EQ(static_cast<std::size_t>(lost), i - skipped + 1);  // once localized, it stays so
      continue;
    }
    EXPECT_LT((first.true_poses[0] * tracked.T_map_robot).Boxminus(truth.back()).norm(), 0.1) << i;
  }
  EXPECT_GT(lost, 0);
  EXPECT_LT(lost, static_cast<int>(second.observations.size() / 2));
  slam.Finish();
  EXPECT_LT(slam.graph().poses.size(), nodes_then + 25);
  EXPECT_GT(slam.statistics().known_scans, (slam.scan_count() - scans_then) / 3);
  const std::vector<double> errors = Errors(first.true_poses[0], slam.ScanPoses(), truth);
  EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 0.1);
}

INSTANTIATE_TEST_SUITE_P(ToldOrNot, SlamInAnOldMap, ::testing::Bool());

TEST(SlamSessions, ARobotInAnotherWorldSaysThatItHasNotFoundItself) {
  World other;
  other.AddBox({1.5, 0.0}, {9.0, 7.5}, 0.3);
  const SimulatedRun first = RoundsIn(DistinctiveRoom(), 1);
  const SimulatedRun second = RoundsIn(other, 1, 3);
  Slam slam;
  for (const Observation& observation : first.observations) slam.AddScan(observation);
  const std::vector<SE2> before = slam.ScanPoses();
  bool begins = true;
  for (Observation observation : second.observations) {
    observation.new_session = std::exchange(begins, false);
    EXPECT_FALSE(slam.AddScan(observation).localized);
  }
  slam.Finish();
  for (const Closure& record : slam.closures()) {
    const bool joins = slam.node_scans()[Index(record.from)] < static_cast<int>(before.size()) &&
                       slam.node_scans()[Index(record.to)] >= static_cast<int>(before.size());
    EXPECT_FALSE(joins && record.outcome == ClosureOutcome::kAccepted);
  }
  // Each part on its own is still right.
  const std::vector<SE2> poses = slam.ScanPoses();
  const SE2 T_world_second = second.true_poses[0] * poses[before.size()].Inverse();
  for (std::size_t i = 0; i < second.true_poses.size(); ++i) {
    EXPECT_LT((T_world_second * poses[before.size() + i]).Boxminus(second.true_poses[i]).norm(),
              0.1);
  }
}

}  // namespace
}  // namespace loopgrid
