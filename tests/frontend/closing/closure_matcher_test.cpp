#include "frontend/closing/closure_matcher.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <vector>

#include "tests/support/rooms.h"

namespace loopgrid {
namespace {

using test_support::DistinctiveRoom;
using test_support::ExactLaser;
using test_support::MapFrom;
using test_support::PortableRandom;
using test_support::ScanFrom;
using test_support::SimulatedLaser;
using test_support::World;

const std::array<SE2, 3> kMapPoses = {SE2(), SE2(1.5, 1.5, 1.0), SE2(-2.5, -1.5, 2.0)};

ClosureMatch Match(const LocalMap& map, const PointScan& scan, const SE2& predicted,
                   const SearchWindow& window, const ClosureMatcherOptions& options = {}) {
  return MatchClosure(map, scan, scan.hits, predicted, window, options);
}

TEST(MatchClosure, FindsAScanInSmallAndLargeWindows) {
  SimulatedLaser all_around = ExactLaser(360);
  all_around.range_noise = 0.01;
  const LocalMap map = MapFrom(DistinctiveRoom(), kMapPoses, all_around);
  const std::array<SearchWindow, 3> windows = {{{0.3, 0.2, 0.1}, {1.2, 1.5, 0.6}, {4, 4, 3.2}}};
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    for (const SearchWindow& window : windows) {
      SCOPED_TRACE(seed);
      PortableRandom random(seed);
      const SE2 truth{random.Uniform(-2.0, 1.0), random.Uniform(-2.0, 0.5), random.Uniform(-3, 3)};
      const SE2 predicted{truth.x() + 0.9 * random.Uniform(-window.x, window.x),
                          truth.y() + 0.9 * random.Uniform(-window.y, window.y),
                          truth.theta() + 0.9 * random.Uniform(-window.rotation, window.rotation)};
      const PointScan scan = ScanFrom(DistinctiveRoom(), truth, SimulatedLaser{}, seed);
      const ClosureMatch match = Match(map, scan, predicted, window);
      ASSERT_TRUE(match.found);
      const Eigen::Vector3d error = match.T_map_robot.Boxminus(truth);
      EXPECT_LT(error.head<2>().norm(), 0.03);
      EXPECT_LT(std::abs(error.z()), 0.01);
      EXPECT_LT(error.dot(match.covariance.ldlt().solve(error)), 16.0);
      EXPECT_LT(match.covariance(0, 0) + match.covariance(1, 1), 0.2 * 0.2);
      EXPECT_GT(match.inlier_share, 0.8);
      EXPECT_LT(match.denied_share, 0.05);
      EXPECT_LE(match.score, 1.0);
      EXPECT_LT(match.second_score, 0.95 * match.score);
    }
  }
}

TEST(MatchClosure, SeesThatAPlaceLooksLikeAnotherOne) {
  World square;  // the same after a quarter turn
  square.AddBox({0.0, 0.0}, {5.0, 5.0});
  const LocalMap map = MapFrom(square, std::array<SE2, 1>{SE2(0.5, 0.3, 0.0)});
  const SE2 truth(0.2, -0.4, 0.3);
  const PointScan scan = ScanFrom(square, truth);
  const ClosureMatch match = Match(map, scan, truth, {2.0, 2.0, 2.0});
  ASSERT_TRUE(match.found);
  EXPECT_GT(match.second_score, 0.75 * match.score);  // less because hits fall between cells
  EXPECT_LE(match.second_score, match.score);
}

TEST(MatchClosure, FindsNothingWhereThereIsNothing) {
  const PointScan scan = ScanFrom(DistinctiveRoom(), SE2());
  const LocalMap map = MapFrom(DistinctiveRoom(), kMapPoses);
  for (const SearchWindow& window : {SearchWindow{0.2, 0.2, 0.1}, SearchWindow{2.0, 2.0, 1.0}}) {
    const ClosureMatch no_map = Match(LocalMap(), scan, SE2(), window);
    EXPECT_FALSE(no_map.found);
    EXPECT_EQ(no_map.score, 0.0);
    EXPECT_FALSE(Match(map, PointScan(), SE2(), window).found);
    EXPECT_FALSE(Match(map, scan, SE2(300.0, 0.0, 0.0), window).found);
    EXPECT_FALSE(MatchClosure(map, PointScan(), scan.hits, SE2(), window, {}).found);
  }
}

TEST(MatchClosure, RefusesAScanOfAnotherPlace) {
  World other;
  other.AddBox({0.3, 0.2}, {1.6, 2.3}, 0.4);
  const LocalMap map = MapFrom(DistinctiveRoom(), kMapPoses);
  const PointScan scan = ScanFrom(other, SE2(0.3, 0.2, 0.0));
  EXPECT_FALSE(Match(map, scan, SE2(0.0, 0.5, 0.0), {0.3, 0.3, 0.1}).found);
}

TEST(MatchClosure, KeepsToItsLimits) {
  const LocalMap map = MapFrom(DistinctiveRoom(), kMapPoses);
  const SE2 truth(0.2, -0.4, 0.3);
  const PointScan scan = ScanFrom(DistinctiveRoom(), truth);
  ClosureMatcherOptions options;
  const double score = Match(map, scan, truth, {0.2, 0.2, 0.1}, options).score;
  options.min_score = score + 0.01;
  EXPECT_FALSE(Match(map, scan, truth, {0.2, 0.2, 0.1}, options).found);
  options = {};
  options.min_inlier_share = 1.1;
  EXPECT_FALSE(Match(map, scan, truth, {0.2, 0.2, 0.1}, options).found);
  options = {};
  options.widest = 0.1;  // windows are not searched farther than this
  EXPECT_TRUE(Match(map, scan, truth, {1e9, 1e9, 1e9}, options).found);
}

TEST(MatchClosure, SearchesLargeWindowsWithTheSurroundings) {
  // One scan of a corner fits every corner. With the rest of the room it fits one place only.
  const LocalMap map = MapFrom(DistinctiveRoom(), kMapPoses);
  const SE2 truth(-2.0, -1.5, -2.4);
  SimulatedLaser narrow = ExactLaser(180);
  narrow.first_angle = -0.6;
  narrow.angle_step = 1.2 / 180.0;
  const PointScan corner = ScanFrom(DistinctiveRoom(), truth, narrow);
  const PointScan around = ScanFrom(DistinctiveRoom(), truth);
  const SearchWindow window{3.0, 3.0, 3.1};
  const ClosureMatch alone = Match(map, corner, SE2(), window);
  const ClosureMatch together = MatchClosure(map, corner, around.hits, SE2(), window, {});
  ASSERT_TRUE(together.found);
  EXPECT_LT(together.T_map_robot.Boxminus(truth).norm(), 0.03);
  EXPECT_LT(together.second_score, 0.85 * together.score);
  EXPECT_GT(alone.second_score, 0.9 * alone.score);
}

}  // namespace
}  // namespace loopgrid
