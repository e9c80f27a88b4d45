#include "apps/live/map_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "tests/support/portable_random.h"

namespace loopgrid {
namespace {

// One cell is one metre, and a single beam that ends there makes it a wall.
OccupancyGrid EmptyGrid() {
  OccupancyGridOptions options;
  options.resolution = 1.0;
  return OccupancyGrid(options);
}

void AddWall(std::int64_t x, std::int64_t y, OccupancyGrid* grid) {
  const Eigen::Vector2f hit(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  const MapScan scan = {.origin = hit.cast<double>(), .hits = {&hit, 1}, .no_returns = {}};
  grid->AddScan(SE2(), scan);
}

void AddFree(std::int64_t x, std::int64_t y, OccupancyGrid* grid) {
  const Eigen::Vector2f hit(static_cast<float>(x) + 1.5f, static_cast<float>(y) + 0.5f);
  const MapScan scan = {.origin = {hit.x() - 1.0, hit.y()}, .hits = {&hit, 1}, .no_returns = {}};
  grid->AddScan(SE2(), scan);
}

cv::Mat Decode(const std::string& png) {
  const std::vector<std::uint8_t> bytes(png.begin(), png.end());
  return cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
}

// The grey value of a pixel of a tile, (0, 0) is the lower left one.
int PixelOf(const MapTiles& tiles, const TileId& id, int x, int y) {
  const auto png = tiles.Png(id);
  if (png == nullptr) return -1;
  return Decode(*png).at<std::uint8_t>(kTileSide - 1 - y, x);
}

std::set<TileId> Ids(const std::vector<TileVersion>& tiles) {
  std::set<TileId> ids;
  for (const TileVersion& tile : tiles) ids.insert(tile.id);
  return ids;
}

TEST(MapTiles, StartEmpty) {
  const MapTiles tiles;
  EXPECT_EQ(tiles.version(), 0u);
  EXPECT_TRUE(tiles.ChangedSince(0).empty());
  EXPECT_EQ(tiles.Png({0, 0, 0}), nullptr);
  const MapPicture picture = tiles.Picture();
  EXPECT_EQ(picture.image.width, 1);
  EXPECT_EQ(picture.image.pixels, std::vector<std::uint8_t>{kGreyUnknown});
}

TEST(MapTiles, CutAtFixedPlacesAlsoBelowZero) {
  OccupancyGrid grid = EmptyGrid();
  AddWall(0, 0, &grid);
  AddWall(-1, 255, &grid);
  AddWall(256, -256, &grid);
  AddWall(-257, -257, &grid);
  MapTiles tiles;
  tiles.Update(grid, grid.SeenBox());
  EXPECT_EQ(PixelOf(tiles, {0, 0, 0}, 0, 0), kGreyWall);
  EXPECT_EQ(PixelOf(tiles, {0, -1, 0}, 255, 255), kGreyWall);
  EXPECT_EQ(PixelOf(tiles, {0, 1, -1}, 0, 0), kGreyWall);
  EXPECT_EQ(PixelOf(tiles, {0, -2, -2}, 255, 255), kGreyWall);
  EXPECT_EQ(PixelOf(tiles, {0, 0, 0}, 1, 0), kGreyUnknown);
  EXPECT_EQ(tiles.Png({0, -1, -1}), nullptr) << "nothing was seen there";
}

TEST(MapTiles, RiseInVersionOnlyWherePixelsChange) {
  OccupancyGrid grid = EmptyGrid();
  AddWall(10, 10, &grid);
  AddWall(300, 10, &grid);
  MapTiles tiles;
  tiles.Update(grid, grid.SeenBox());
  const std::uint64_t first = tiles.version();
  EXPECT_EQ(Ids(tiles.ChangedSince(0)).count({0, 1, 0}), 1u);

  AddWall(10, 10, &grid);  // more evidence, the same picture
  tiles.Update(grid, grid.SeenBox());
  EXPECT_EQ(tiles.version(), first);

  AddFree(70, 70, &grid);
  tiles.Update(grid, {0, 0, 1000, 1000});
  std::set<TileId> expected;
  for (int level = 0; level < kTileLevels; ++level) expected.insert({level, 0, 0});
  EXPECT_EQ(Ids(tiles.ChangedSince(first)), expected);
  EXPECT_TRUE(tiles.ChangedSince(tiles.version()).empty());
  EXPECT_EQ(tiles.ChangedSince(first).back().version, tiles.version());
}

TEST(MapTiles, EncodeWhatChangedAnew) {
  OccupancyGrid grid = EmptyGrid();
  AddWall(10, 10, &grid);
  MapTiles tiles;
  tiles.Update(grid, grid.SeenBox());
  std::uint64_t before = 0;
  const auto png = tiles.Png({0, 0, 0}, &before);
  EXPECT_EQ(tiles.Png({0, 0, 0}), png) << "encoded once";
  AddWall(11, 10, &grid);
  tiles.Update(grid, grid.SeenBox());
  std::uint64_t after = 0;
  EXPECT_NE(*tiles.Png({0, 0, 0}, &after), *png);
  EXPECT_GT(after, before);
}

// The oracle computes every coarse pixel from all of its cells.
TEST(MapTiles, ShowWallsAndFreeSpaceOnEveryLevel) {
  OccupancyGrid grid = EmptyGrid();
  test_support::PortableRandom random(3);
  MapTiles tiles;
  for (int round = 0; round < 5; ++round) {
    for (int i = 0; i < 40; ++i) {
      const auto x = static_cast<std::int64_t>(random.Uniform(-500.0, 500.0));
      const auto y = static_cast<std::int64_t>(random.Uniform(-500.0, 500.0));
      i % 2 == 0 ? AddWall(x, y, &grid) : AddFree(x, y, &grid);
    }
    tiles.Update(grid, grid.SeenBox());
  }
  const CellBox seen = grid.SeenBox();
  for (int level = 0; level < kTileLevels; ++level) {
    std::map<std::pair<std::int64_t, std::int64_t>, int> expected;
    for (std::int64_t y = seen.min_y; y < seen.max_y; ++y) {
      for (std::int64_t x = seen.min_x; x < seen.max_x; ++x) {
        const CellState state = grid.State(x, y);
        if (state == CellState::kUnknown) continue;
        int& pixel = expected.try_emplace({x >> level, y >> level}, kGreyFree).first->second;
        if (state == CellState::kWall) pixel = kGreyWall;
      }
    }
    std::size_t known = 0;
    for (const TileVersion& tile : tiles.ChangedSince(0)) {
      if (tile.id.level != level) continue;
      const cv::Mat image = Decode(*tiles.Png(tile.id));
      for (int y = 0; y < kTileSide; ++y) {
        for (int x = 0; x < kTileSide; ++x) {
          const int grey = image.at<std::uint8_t>(kTileSide - 1 - y, x);
          const auto found = expected.find(
              {std::int64_t{tile.id.x} * kTileSide + x, std::int64_t{tile.id.y} * kTileSide + y});
          ASSERT_EQ(grey, found == expected.end() ? kGreyUnknown : found->second)
              << "level " << level << " tile " << tile.id.x << ' ' << tile.id.y;
          known += found == expected.end() ? 0 : 1;
        }
      }
    }
    EXPECT_EQ(known, expected.size()) << "level " << level;
  }
}

TEST(MapTiles, GiveTheWholePictureAsDrawMapDoes) {
  OccupancyGrid grid = EmptyGrid();
  AddWall(-300, 7, &grid);
  AddFree(5, -270, &grid);
  AddWall(290, 20, &grid);
  MapTiles tiles;
  tiles.Update(grid, grid.SeenBox());
  const GreyImage expected = DrawMap(grid);
  const MapPicture picture = tiles.Picture();
  EXPECT_EQ(picture.image.width, expected.width);
  EXPECT_EQ(picture.image.height, expected.height);
  EXPECT_TRUE(picture.image.pixels == expected.pixels);
  EXPECT_EQ(MapYaml(picture.box, 1.0, "map.pgm"), MapYaml(grid, "map.pgm"));
}

// The oracle computes every pixel of the picture from all of its cells.
TEST(MapTiles, DrawAPictureCoarserThatWouldBeTooLarge) {
  OccupancyGrid grid = EmptyGrid();
  AddWall(-300, 7, &grid);
  AddFree(5, -270, &grid);
  AddWall(290, 20, &grid);
  AddFree(291, 21, &grid);
  MapTiles tiles;
  tiles.Update(grid, grid.SeenBox());
  const CellBox seen = grid.SeenBox();
  ASSERT_EQ(std::max(seen.width(), seen.height()), 593);
  for (const auto& [max_side, level] : std::vector<std::pair<int, int>>{
           {593, 0}, {592, 1}, {100, 3}, {10, 6}, {4, 8}, {3, 9}, {2, 9}}) {
    const MapPicture picture = tiles.Picture(max_side);
    EXPECT_EQ(picture.cells_per_pixel, 1 << level) << max_side;
    EXPECT_LE(std::max(picture.image.width, picture.image.height), max_side);
    std::vector<std::uint8_t> expected(picture.image.pixels.size(), kGreyUnknown);
    for (std::int64_t y = seen.min_y; y < seen.max_y; ++y) {
      for (std::int64_t x = seen.min_x; x < seen.max_x; ++x) {
        const CellState state = grid.State(x, y);
        if (state == CellState::kUnknown) continue;
        const std::int64_t row = picture.box.max_y - 1 - (y >> level);
        const std::int64_t column = (x >> level) - picture.box.min_x;
        auto& pixel = expected.at(static_cast<std::size_t>(row * picture.box.width() + column));
        if (pixel != kGreyWall) pixel = state == CellState::kWall ? kGreyWall : kGreyFree;
      }
    }
    EXPECT_TRUE(picture.image.pixels == expected) << max_side;
  }
}

}  // namespace
}  // namespace loopgrid
