#include "frontend/closing/place_finder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "tests/frontend/slam/walk.h"
#include "tests/support/portable_random.h"

namespace loopgrid {
namespace {

using test_support::DistinctiveRoom;
using test_support::ExactLaser;
using test_support::kNodesARound;
using test_support::RoundWalk;
using test_support::ScanFrom;
using test_support::Walk;
using test_support::World;

// Coarser than the defaults, to be faster. The room is small, and every scan sees most of it.
ClosureMatcherOptions Coarse() {
  ClosureMatcherOptions options;
  options.coarse_points = 100;
  return options;
}

TEST(PlaceFinder, FindsTheRobotAnywhereInTheRoomWhicheverWayItLooks) {
  Walk walk;
  walk.Follow(DistinctiveRoom(), RoundWalk(kNodesARound));
  const PlaceFinder finder(walk.nodes(), walk.nodes().size());
  constexpr std::uint32_t kSeed = 11;
  test_support::PortableRandom random(kSeed);
  for (int i = 0; i < 5; ++i) {
    const SE2 truth(random.Uniform(-2.0, 2.0), random.Uniform(-0.5, 1.5),
                    random.Uniform(-std::numbers::pi, std::numbers::pi));
    const PointScan scan = ScanFrom(DistinctiveRoom(), truth, ExactLaser(360));
    const std::optional<FoundPlace> found = finder.Find(scan, scan.hits, Coarse());
    ASSERT_TRUE(found) << "seed " << kSeed << ", place " << i;
    const SE2 pose = walk.nodes().pose(found->node) * found->match.T_map_robot;
    EXPECT_LT(pose.Boxminus(truth).norm(), 0.05) << "seed " << kSeed << ", place " << i;
    EXPECT_LT(found->match.second_score, 0.9 * found->match.score);
    for (const SE2& node : walk.nodes().graph->poses) {
      EXPECT_LE(found->match.T_map_robot.translation().norm(),
                (node.translation() - pose.translation()).norm() + 1e-9);
    }
  }
}

TEST(PlaceFinder, FindsNothingInAnotherWorld) {
  Walk walk;
  walk.Follow(DistinctiveRoom(), RoundWalk(kNodesARound));
  const PlaceFinder finder(walk.nodes(), walk.nodes().size());
  World elsewhere;
  elsewhere.AddBox({0.0, 0.0}, {28.0, 2.4}, 0.4);
  const PointScan scan = ScanFrom(elsewhere, SE2(), ExactLaser(360));
  EXPECT_FALSE(finder.Find(scan, scan.hits, Coarse()));
}

TEST(PlaceFinder, SaysThatASecondPlaceLooksTheSame) {
  // Two equal rooms, 30 m apart.
  World world = DistinctiveRoom();
  for (const test_support::Wall& wall : DistinctiveRoom().walls) {
    const Eigen::Vector2d offset(30.0, 0.0);
    world.walls.push_back({wall.from + offset, wall.to + offset, wall.glass});
  }
  std::vector<SE2> truth = RoundWalk(kNodesARound);
  for (const SE2& pose : RoundWalk(kNodesARound)) truth.push_back(SE2(30.0, 0.0, 0.0) * pose);
  Walk walk;
  walk.Follow(world, truth);
  const PlaceFinder finder(walk.nodes(), walk.nodes().size());
  const PointScan scan = ScanFrom(world, SE2(0.5, 0.5, 2.0), ExactLaser(360));
  const std::optional<FoundPlace> found = finder.Find(scan, scan.hits, Coarse());
  ASSERT_TRUE(found);
  EXPECT_GT(found->match.second_score, 0.92 * found->match.score);
}

TEST(PlaceFinder, KnowsOnlyTheNodesItWasGiven) {
  Walk walk;
  walk.Follow(DistinctiveRoom(), RoundWalk(kNodesARound));
  const PointScan scan = ScanFrom(DistinctiveRoom(), SE2(0.5, 0.5, 2.0), ExactLaser(360));
  EXPECT_FALSE(PlaceFinder(walk.nodes(), 0).Find(scan, scan.hits, Coarse()));
  EXPECT_FALSE(PlaceFinder(walk.nodes(), walk.nodes().size()).Find(PointScan(), {}, Coarse()));
}

}  // namespace
}  // namespace loopgrid
