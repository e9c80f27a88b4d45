#include "frontend/matching/visibility.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "tests/support/rooms.h"

namespace loopgrid {
namespace {

using test_support::DistinctiveRoom;
using test_support::ExactLaser;
using test_support::MapFrom;
using test_support::ScanFrom;
using test_support::SimulatedLaser;
using test_support::World;

World OneWall(double x) {
  World world;
  world.walls.push_back({{x, -3.0}, {x, 3.0}});
  return world;
}

LocalMap VisibleMapOf(const World& world, const SimulatedLaser& laser = ExactLaser()) {
  return MapFrom(world, std::array<SE2, 1>{SE2()}, laser);
}

TEST(CompareVisibility, AScanInItsPlaceDeniesNothing) {
  const std::vector<SE2> map_poses = {SE2(), SE2(1.0, 2.0, 1.0), SE2(-2.5, -1.0, 2.0)};
  const LocalMap map = MapFrom(DistinctiveRoom(), map_poses);
  SimulatedLaser offset = ExactLaser();
  offset.T_robot_laser = SE2(0.3, 0.1, 1.0);
  for (const SimulatedLaser& laser : {ExactLaser(), offset, SimulatedLaser{}}) {
    for (const SE2& pose : {SE2(0.5, 0.5, 0.3), SE2(-2.0, -2.0, -2.0), SE2(4.0, 0.0, 3.0)}) {
      const Visibility visibility =
          CompareVisibility(map, ScanFrom(DistinctiveRoom(), pose, laser), pose);
      EXPECT_LE(visibility.denied_share(), 0.02) << pose.coordinates().transpose();
      EXPECT_GE(visibility.confirmed, 50);
    }
  }
}

TEST(CompareVisibility, AWallInFrontOfWhereBeamsEndedIsDenied) {
  const PointScan scan = ScanFrom(OneWall(4.0), SE2());
  const Visibility nearer = CompareVisibility(VisibleMapOf(OneWall(3.0)), scan, SE2());
  EXPECT_EQ(nearer.confirmed, 0);
  EXPECT_GE(nearer.denied, 60);
  EXPECT_EQ(nearer.denied_share(), 1.0);
  // Within the tolerance it is the same wall.
  const Visibility close = CompareVisibility(VisibleMapOf(OneWall(3.9)), scan, SE2());
  EXPECT_EQ(close.denied, 0);
  EXPECT_GE(close.confirmed, 60);
}

TEST(CompareVisibility, WallsBehindHitsSayNothing) {
  const Visibility visibility =
      CompareVisibility(VisibleMapOf(OneWall(5.0)), ScanFrom(OneWall(2.0), SE2()), SE2());
  EXPECT_EQ(visibility.denied, 0);
  EXPECT_EQ(visibility.confirmed, 0);
  EXPECT_EQ(visibility.denied_share(), 1.0);  // no surface confirms the pose
}

TEST(CompareVisibility, WallsOutsideTheFieldOfViewSayNothing) {
  SimulatedLaser ahead = ExactLaser(180);
  ahead.first_angle = -0.5;
  ahead.angle_step = 1.0 / 180.0;
  const PointScan scan = ScanFrom(OneWall(6.0), SE2(), ahead);
  const Visibility behind = CompareVisibility(VisibleMapOf(OneWall(-2.0)), scan, SE2());
  EXPECT_EQ(behind.denied + behind.confirmed, 0);
  const Visibility turned =
      CompareVisibility(VisibleMapOf(OneWall(-2.0)), scan, SE2(0.0, 0.0, -3.1));
  EXPECT_GT(turned.denied, 20);
}

TEST(CompareVisibility, BeamsThatMetNothingDenyWallsInTheirWay) {
  const PointScan nothing = ScanFrom(World{}, SE2());
  ASSERT_EQ(nothing.size(), 0U);
  EXPECT_EQ(CompareVisibility(VisibleMapOf(OneWall(5.0)), nothing, SE2()).denied_share(), 1.0);
  EXPECT_GE(CompareVisibility(VisibleMapOf(OneWall(5.0)), nothing, SE2()).denied, 60);
  // Too far to compare: with a small error of the angle a beam misses the surface.
  const Visibility far = CompareVisibility(VisibleMapOf(OneWall(13.0)), nothing, SE2());
  EXPECT_EQ(far.denied + far.confirmed, 0);
}

TEST(CompareVisibility, OnlyFacesTurnedToTheLaserCount) {
  // The map contains the other face of the wall.
  const LocalMap back = MapFrom(OneWall(2.0), std::array<SE2, 1>{SE2(5.0, 0.0, 0.0)});
  const Visibility visibility = CompareVisibility(back, ScanFrom(OneWall(6.0), SE2()), SE2());
  EXPECT_EQ(visibility.denied + visibility.confirmed, 0);
}

TEST(CompareVisibility, WithoutAMapOrBeamsNothingIsInView) {
  const PointScan scan = ScanFrom(OneWall(2.0), SE2());
  EXPECT_EQ(CompareVisibility(LocalMap(), scan, SE2()).denied_share(), 1.0);
  EXPECT_EQ(CompareVisibility(VisibleMapOf(OneWall(2.0)), PointScan(), SE2()).denied_share(), 1.0);
}

TEST(Visibility, DeniedShareIsThatOfTheSurfelsInView) {
  EXPECT_EQ((Visibility{3, 1}).denied_share(), 0.25);
  EXPECT_EQ((Visibility{5, 0}).denied_share(), 0.0);
  EXPECT_EQ(Visibility{}.denied_share(), 1.0);
}

}  // namespace
}  // namespace loopgrid
