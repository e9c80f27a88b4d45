#include "mapping/map_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "backend/base/error.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using testing::HasSubstr;

// One beam to the right along y = -0.15, from x = -0.35 to the wall at x = 0.65.
OccupancyGrid SmallGrid() {
  OccupancyGrid grid({.resolution = 0.1});
  const std::vector<Eigen::Vector2f> hits = {{1.0F, 0.0F}, {1.0F, 0.5F}};
  grid.AddScan(SE2(-0.35, -0.15, 0.0), {.hits = hits, .no_returns = {}});
  return grid;
}

cv::Mat DecodePixels(const std::string& bytes) {
  return cv::imdecode(std::vector<unsigned char>(bytes.begin(), bytes.end()), cv::IMREAD_UNCHANGED);
}

// The trinary rule of ROS's map_server, with the numbers from the yaml.
CellState MapServerState(int value, const std::string& yaml) {
  const auto number = [&yaml](const std::string& key) {
    return std::stod(yaml.substr(yaml.find(key + ": ") + key.size() + 2));
  };
  const double occupancy = (number("negate") != 0.0 ? value : 255 - value) / 255.0;
  if (occupancy > number("occupied_thresh")) return CellState::kWall;
  if (occupancy < number("free_thresh")) return CellState::kFree;
  return CellState::kUnknown;
}

TEST(MapFiles, MapServerReadsTheSameThreeClassesAtTheSamePlaces) {
  const OccupancyGrid grid = SmallGrid();
  const std::string yaml = MapYaml(grid, "map.pgm");
  const cv::Mat image = DecodePixels(EncodePgm(DrawMap(grid)));
  ASSERT_EQ(image.type(), CV_8UC1);
  double origin_x = 0.0;
  double origin_y = 0.0;
  double yaw = 1.0;
  ASSERT_EQ(std::sscanf(yaml.c_str() + yaml.find("origin"), "origin: [%lf, %lf, %lf]", &origin_x,
                        &origin_y, &yaw),
            3);
  EXPECT_EQ(yaw, 0.0);
  int known = 0;
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.cols; ++column) {
      // map_server turns the image upside down: the last row is at the origin.
      const double x = origin_x + (column + 0.5) * 0.1;
      const double y = origin_y + (image.rows - 1 - row + 0.5) * 0.1;
      const CellState state = grid.State(static_cast<std::int64_t>(std::floor(x / 0.1)),
                                         static_cast<std::int64_t>(std::floor(y / 0.1)));
      EXPECT_EQ(MapServerState(image.at<unsigned char>(row, column), yaml), state)
          << "row " << row << ", column " << column;
      known += state != CellState::kUnknown;
    }
  }
  EXPECT_GT(known, 15);
}

TEST(MapFiles, TopRowIsTheLargestY) {
  const GreyImage image = DrawMap(SmallGrid());
  ASSERT_EQ(image.width, 11);
  ASSERT_EQ(image.height, 6);
  EXPECT_EQ(image.pixels[10], kGreyWall);  // the hit at y = 0.35
  EXPECT_EQ(image.pixels[0], kGreyUnknown);
  EXPECT_EQ(image.pixels[5 * 11], kGreyFree);
  EXPECT_EQ(image.pixels[5 * 11 + 10], kGreyWall);
}

TEST(MapFiles, YamlSaysWhatTheConventionAsksFor) {
  EXPECT_EQ(MapYaml(SmallGrid(), "map.pgm"),
            "image: map.pgm\n"
            "resolution: 0.1\n"
            "origin: [-0.400000, -0.200000, 0.0]\n"
            "negate: 0\n"
            "occupied_thresh: 0.65\n"
            "free_thresh: 0.196\n");
}

TEST(MapFiles, PngAndPgmHoldTheSamePixels) {
  const GreyImage image = DrawMap(SmallGrid());
  const cv::Mat png = DecodePixels(EncodePng(image));
  const cv::Mat pgm = DecodePixels(EncodePgm(image));
  ASSERT_EQ(png.type(), CV_8UC1);
  ASSERT_EQ(png.size(), cv::Size(image.width, image.height));
  EXPECT_EQ(cv::norm(png, pgm, cv::NORM_INF), 0.0);
  EXPECT_EQ(std::vector<std::uint8_t>(png.begin<std::uint8_t>(), png.end<std::uint8_t>()),
            image.pixels);
}

TEST(MapFiles, ANothingSeenGridIsOneUnknownPixel) {
  const GreyImage image = DrawMap(OccupancyGrid());
  EXPECT_EQ(image.width, 1);
  EXPECT_EQ(image.height, 1);
  EXPECT_EQ(image.pixels, std::vector<std::uint8_t>{kGreyUnknown});
}

TEST(MapFiles, RefusesAnImageLargerThanProgramsTake) {
  OccupancyGrid grid({.resolution = 0.01});
  const std::vector<Eigen::Vector2f> hits = {{400.0F, 0.0F}};
  grid.AddScan(SE2(), {.hits = hits, .no_returns = {}});
  EXPECT_THAT([&] { DrawMap(grid); }, testing::ThrowsMessage<Error>(HasSubstr("40001 x 1")));
}

TEST(MapFiles, AreWrittenIntoTheFolder) {
  const test_support::TemporaryDirectory folder;
  const OccupancyGrid grid = SmallGrid();
  WriteMapFiles(grid, folder.path());
  EXPECT_EQ(test_support::ReadFile(folder.File("map.png")), EncodePng(DrawMap(grid)));
  EXPECT_EQ(test_support::ReadFile(folder.File("map.pgm")), EncodePgm(DrawMap(grid)));
  EXPECT_EQ(test_support::ReadFile(folder.File("map.yaml")), MapYaml(grid, "map.pgm"));
  EXPECT_EQ(folder.Names().size(), 3u);
}

TEST(MapFiles, AFolderThatIsNotThereIsAnOutputError) {
  const test_support::TemporaryDirectory folder;
  try {
    WriteMapFiles(SmallGrid(), folder.File("missing"));
    FAIL() << "expected an Error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kOutput);
    EXPECT_THAT(error.what(), HasSubstr("missing/map.png: "));
  }
}

}  // namespace
}  // namespace loopgrid
