#include "frontend/matching/point_scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/support/rooms.h"

namespace loopgrid {
namespace {

using test_support::DistinctiveRoom;
using test_support::ExactLaser;
using test_support::ScanFrom;
using test_support::SimulatedLaser;
using test_support::World;

constexpr double kScanPi = std::numbers::pi;

LaserScan BeamScanOf(std::vector<float> ranges) {
  LaserScan scan;
  scan.first_angle = -0.5 * kScanPi;
  scan.angle_step = kScanPi / 180.0;
  scan.ranges = std::move(ranges);
  return scan;
}

// A wall at the distance `d` from the robot, its foot in the direction `angle`.
World WallAt(double d, double angle) {
  const SE2 T(0.0, 0.0, angle);
  World world;
  world.walls.push_back({T * Eigen::Vector2d(d, -50.0), T * Eigen::Vector2d(d, 50.0)});
  return world;
}

TEST(MakePointScan, PlacesEachReadingAlongItsBeam) {
  LaserScan scan = BeamScanOf({1.0F, 2.0F, 3.0F});
  scan.first_angle = -0.5;
  scan.angle_step = 0.25;
  for (const SE2& mount : {SE2(), SE2(0.3, -0.1, 0.0), SE2(0.2, 0.0, 2.5), SE2(0, 0, kScanPi)}) {
    scan.T_robot_laser = mount;
    const PointScan points = MakePointScan(scan, 0.05, 40.0);
    ASSERT_EQ(points.size(), 3U);
    for (int i = 0; i < 3; ++i) {
      const double angle = -0.5 + 0.25 * i;
      const Eigen::Vector2d in_laser((i + 1) * std::cos(angle), (i + 1) * std::sin(angle));
      const Eigen::Vector2d expected = mount * in_laser;
      EXPECT_NEAR((points.hits[static_cast<std::size_t>(i)].cast<double>() - expected).norm(), 0.0,
                  1e-6);
    }
    EXPECT_EQ(points.T_robot_laser.coordinates(), mount.coordinates());
  }
}

TEST(MakePointScan, TakesBeamsThatRunClockwise) {
  LaserScan scan = BeamScanOf({1.0F, 1.0F});
  scan.first_angle = 0.5 * kScanPi;
  scan.angle_step = -0.5 * kScanPi;
  const PointScan points = MakePointScan(scan, 0.05, 40.0);
  EXPECT_NEAR((points.hits[0] - Eigen::Vector2f(0.0F, 1.0F)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((points.hits[1] - Eigen::Vector2f(1.0F, 0.0F)).norm(), 0.0, 1e-6);
}

TEST(MakePointScan, KeepsHitsBetweenTheLimitsAndNoReturnsFromTheUpperOneOn) {
  const float just_below = std::nextafter(8.0F, 0.0F);
  LaserScan scan = BeamScanOf({0.0F, 0.04F, 0.0625F, just_below, 8.0F, 81.83F, kFarthestReading});
  scan.T_robot_laser = SE2(0.2, 0.1, 0.5 * kScanPi);
  const PointScan points = MakePointScan(scan, 0.0625, 8.0);
  EXPECT_EQ(points.size(), 2U);
  ASSERT_EQ(points.no_returns.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const double angle = (static_cast<double>(i) + 4.0) * kScanPi / 180.0;  // beams 4, 5 and 6
    const Eigen::Vector2d expected(std::cos(angle), std::sin(angle));
    EXPECT_NEAR((points.no_returns[i].cast<double>() - expected).norm(), 0.0, 1e-6);
  }
}

TEST(MakePointScan, DropsReadingsThatAreNoNumber) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const PointScan points = MakePointScan(BeamScanOf({nan, 1.0F, nan}), 0.05, 40.0);
  EXPECT_EQ(points.size(), 1U);
  EXPECT_TRUE(points.no_returns.empty());
}

TEST(MakePointScan, OfNoReturnsAloneHasNoHits) {
  const PointScan points = MakePointScan(BeamScanOf(std::vector<float>(180, 81.83F)), 0.05, 40.0);
  EXPECT_EQ(points.size(), 0U);
  EXPECT_TRUE(points.normals.empty());
  EXPECT_EQ(points.no_returns.size(), 180U);
}

TEST(MakePointScan, NormalsStandOnAStraightWallAndFaceTheLaser) {
  for (double angle : {0.0, 0.3, 0.5 * kScanPi, 2.0, kScanPi, -1.1, -3.0}) {
    for (double offset : {0.0, 0.25, -0.4}) {
      SCOPED_TRACE(angle);
      SimulatedLaser laser = ExactLaser(360);
      laser.T_robot_laser = SE2(offset, 0.5 * offset, 2.0 * offset);
      const PointScan points = ScanFrom(WallAt(2.0, angle), SE2(), laser);
      const Eigen::Vector2f expected(static_cast<float>(-std::cos(angle)),
                                     static_cast<float>(-std::sin(angle)));
      ASSERT_EQ(points.normals.size(), points.size());
      int with_normal = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (points.normals[i].isZero()) continue;
        ++with_normal;
        ASSERT_NEAR((points.normals[i] - expected).norm(), 0.0, 2e-3);
      }
      EXPECT_GE(with_normal, 130);  // all except the most grazing beams
    }
  }
}

TEST(MakePointScan, NormalsAreUnitOrZeroAndFaceTheLaserEverywhere) {
  SimulatedLaser laser;  // with noise
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const PointScan points = ScanFrom(DistinctiveRoom(), SE2(0.1 * seed, 0.0, seed), laser, seed);
    const Eigen::Vector2f eye = laser.T_robot_laser.translation().cast<float>();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2f& normal = points.normals[i];
      if (normal.isZero()) continue;
      EXPECT_NEAR(normal.norm(), 1.0F, 1e-5F);
      EXPECT_GE(normal.dot(eye - points.hits[i]), 0.0F);
    }
  }
}

TEST(MakePointScan, LonePointsAndPairsHaveNoNormal) {
  std::vector<float> ranges(180, 81.83F);
  ranges[20] = 2.0F;               // alone
  ranges[60] = ranges[61] = 2.0F;  // a pair
  ranges[99] = 2.0F;               // a post of three beams ...
  ranges[100] = ranges[101] = 2.0F;
  const PointScan points = MakePointScan(BeamScanOf(ranges), 0.05, 40.0);
  ASSERT_EQ(points.size(), 6U);
  for (std::size_t i : {0U, 1U, 2U}) EXPECT_TRUE(points.normals[i].isZero()) << i;
  for (std::size_t i : {3U, 4U, 5U}) EXPECT_FALSE(points.normals[i].isZero()) << i;
}

TEST(MakePointScan, NoNormalIsTakenAcrossAGap) {
  // Every other point is 2 m behind, so no two neighbours belong to one surface.
  std::vector<float> ranges;
  for (int i = 0; i < 180; ++i) ranges.push_back(i % 2 == 0 ? 2.0F : 4.0F);
  for (const Eigen::Vector2f& normal : MakePointScan(BeamScanOf(ranges), 0.05, 40.0).normals) {
    EXPECT_TRUE(normal.isZero());
  }
  // A step in depth: both sides keep the normal of their own wall.
  World world;
  world.walls.push_back({{2.0, -3.0}, {2.0, 0.0}});
  world.walls.push_back({{4.0, -3.0}, {4.0, 3.0}});
  const PointScan points = ScanFrom(world, SE2());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.normals[i].isZero()) continue;
    EXPECT_NEAR(points.normals[i].x(), -1.0F, 1e-3F) << points.hits[i].transpose();
  }
}

TEST(MakePointScan, ScatteredPointsHaveNoNormal) {
  test_support::PortableRandom random(5);
  std::vector<float> ranges;
  for (int i = 0; i < 180; ++i) ranges.push_back(static_cast<float>(random.Uniform(2.0, 2.2)));
  const PointScan points = MakePointScan(BeamScanOf(ranges), 0.05, 40.0);
  int with_normal = 0;
  for (const Eigen::Vector2f& normal : points.normals) with_normal += normal.isZero() ? 0 : 1;
  EXPECT_LT(with_normal, 20);
}

}  // namespace
}  // namespace loopgrid
