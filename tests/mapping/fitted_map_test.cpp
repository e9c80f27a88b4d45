#include "mapping/fitted_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "backend/base/error.h"
#include "mapping/map_files.h"
#include "tests/mapping/drawing_testing.h"

namespace loopgrid {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Every scan sees one wall a metre ahead.
MapScan OneWall(std::size_t) {
  static const std::vector<Eigen::Vector2f> kHits = {{1.0F, 0.0F}};
  return {.hits = kHits, .no_returns = {}};
}

/// `count` robots a metre apart.
std::vector<SE2> Row(int count) {
  std::vector<SE2> poses;
  for (int i = 0; i < count; ++i) poses.emplace_back(1.0 * i, 0.0, 0.0);
  return poses;
}

void ExpectSameMap(const OccupancyGrid& map, const OccupancyGrid& expected) {
  EXPECT_EQ(EncodePgm(DrawMap(map)), EncodePgm(DrawMap(expected)));
  EXPECT_EQ(MapYaml(map, "map.pgm"), MapYaml(expected, "map.pgm"));
}

TEST(RenderFittedMap, IsRenderMapWhereAllFits) {
  const std::vector<SE2> poses = Row(20);
  const FittedMap map = RenderFittedMap(poses, OneWall, {});
  EXPECT_THAT(map.left_out, IsEmpty());
  ExpectSameMap(map.grid, RenderMap(poses, OneWall));
}

TEST(RenderFittedMap, LeavesOutOneScanThreeHundredKilometresOff) {
  for (const SE2& stray :
       {SE2(3e5, 0.0, 0.0), SE2(-2e5, 3e5, 1.0), SE2(0.0, 1e9, 0.0), SE2(2000.0, 1500.0, 0.0),
        SE2(std::numeric_limits<double>::infinity(), 0.0, 0.0)}) {
    std::vector<SE2> poses = Row(50);
    const OccupancyGrid expected = RenderMap(poses, OneWall);
    poses.insert(poses.begin() + 30, stray);
    const FittedMap map = RenderFittedMap(poses, OneWall, {});
    EXPECT_THAT(map.left_out, ElementsAre(30));
    ExpectSameMap(map.grid, expected);
  }
}

TEST(RenderFittedMap, HasLargerCellsWhereMostScansNeedThem) {
  const std::vector<SE2> poses = Row(100);
  const FittedMap map =
      RenderFittedMap(poses, OneWall, {.resolution = 0.01}, {.max_side = 1000, .coarsest = 1.0});
  EXPECT_THAT(map.left_out, IsEmpty());
  // 10,000 cells a side. With 0.10 m there would be a few more than 1,000, because of the borders.
  EXPECT_DOUBLE_EQ(map.grid.resolution(), 0.11);
  EXPECT_LE(DrawMap(map.grid).width, 1000);
  // Every wall is still visible.
  for (int i = 1; i <= 100; ++i) {
    EXPECT_EQ(map.grid.State(static_cast<std::int64_t>(i / map.grid.resolution()), 0),
              CellState::kWall)
        << i;
  }
}

TEST(RenderFittedMap, HasLargerCellsWhereThereWouldBeTooMany) {
  std::vector<SE2> poses = Row(30);
  for (int i = 0; i < 30; ++i) poses.emplace_back(0.0, 1.0 * i, 0.0);
  OccupancyGridOptions options;
  options.max_cells = 100'000;  // 316 a side, where 600 would be needed
  const FittedMap map = RenderFittedMap(poses, OneWall, options);
  EXPECT_THAT(map.left_out, IsEmpty());
  EXPECT_DOUBLE_EQ(map.grid.resolution(), 0.1);
}

TEST(RenderFittedMap, ShowsTheLargerOfTwoPlacesTooFarApart) {
  std::vector<SE2> poses = Row(20);
  const OccupancyGrid expected = RenderMap(poses, OneWall);
  for (int i = 0; i < 15; ++i) poses.emplace_back(3e5, -3e5 + i, 0.0);
  const FittedMap map = RenderFittedMap(poses, OneWall, {});
  ASSERT_EQ(map.left_out.size(), 15u);
  EXPECT_EQ(map.left_out.front(), 20u);
  EXPECT_EQ(map.left_out.back(), 34u);
  ExpectSameMap(map.grid, expected);
}

TEST(RenderFittedMap, IsEmptyIfNoScanHasAPlace) {
  const std::vector<SE2> poses = {SE2(1e300, 0.0, 0.0), SE2(0.0, -1e300, 0.0)};
  const FittedMap map = RenderFittedMap(poses, OneWall, {});
  EXPECT_THAT(map.left_out, ElementsAre(0, 1));
  EXPECT_TRUE(map.grid.SeenBox().empty());
  EXPECT_TRUE(RenderFittedMap({}, OneWall, {}).grid.SeenBox().empty());
}

TEST(RenderBackdrop, KeepsToAFewCellsHoweverLargeTheMap) {
  std::vector<SE2> poses = {SE2(), SE2(5000.0, 3000.0, 0.0)};
  const OccupancyGrid large = test_support::Backdrop(poses);
  EXPECT_LE(large.SeenBox().width(), 1202);
  poses.pop_back();
  EXPECT_EQ(test_support::Backdrop(poses).resolution(), OccupancyGridOptions().resolution);
}

TEST(RenderBackdrop, TakesWhateverHasAPlace) {
  for (double far : {3e5, 5e7, 1e9, 1e300}) {
    const OccupancyGrid map = test_support::Backdrop({SE2(), SE2(far, -far, 0.0)});
    EXPECT_LE(map.SeenBox().width(), 1202) << far;
    EXPECT_FALSE(map.SeenBox().empty()) << far;
  }
}

}  // namespace
}  // namespace loopgrid
