#include "mapping/map_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace loopgrid {
namespace {

constexpr Color kInk{200, 10, 20};
constexpr Color kFree{230, 230, 230};
constexpr Color kWallColor{100, 100, 100};

Eigen::AlignedBox2d Box(double min_x, double min_y, double max_x, double max_y) {
  return {Eigen::Vector2d(min_x, min_y), Eigen::Vector2d(max_x, max_y)};
}

// The distance between the outermost inked pixels along a direction of the picture.
double InkedExtent(const Canvas& canvas, const Eigen::Vector2d& direction) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x) {
      if (canvas.At(x, y).green > 128) continue;
      low = std::min(low, direction.dot(Eigen::Vector2d(x, y)));
      high = std::max(high, direction.dot(Eigen::Vector2d(x, y)));
    }
  }
  return high - low;
}

int Count(const Canvas& canvas, Color color) {
  int count = 0;
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x) count += canvas.At(x, y) == color;
  }
  return count;
}

TEST(MapView, FitsTheExtentAndCentresIt) {
  Canvas canvas(500, 300);
  const MapView view(&canvas, {20, 30, 400, 200}, Box(-1.0, 5.0, 1.0, 9.0));
  EXPECT_DOUBLE_EQ(view.pixels_per_metre(), 50.0);
  EXPECT_TRUE(view.ToPixel({0.0, 7.0}).isApprox(Eigen::Vector2d(220.0, 130.0)));
  EXPECT_TRUE(view.ToPixel({1.0, 9.0}).isApprox(Eigen::Vector2d(270.0, 30.0)));
}

TEST(MapView, AnExtentWithoutSizeIsSeenAsASquareMetre) {
  Canvas canvas(100, 100);
  const MapView nothing(&canvas, {0, 0, 100, 100}, Eigen::AlignedBox2d());
  EXPECT_DOUBLE_EQ(nothing.pixels_per_metre(), 100.0);
  const MapView point(&canvas, {0, 0, 100, 100}, Box(3.0, 4.0, 3.0, 4.0));
  EXPECT_TRUE(point.ToPixel({3.0, 4.0}).isApprox(Eigen::Vector2d(50.0, 50.0)));
}

// A wall of one cell at (10.05, 0.05), all cells from x = 0 on before it free.
OccupancyGrid OneBeam() {
  OccupancyGrid grid({.resolution = 0.1});
  const std::vector<Eigen::Vector2f> hits = {{10.0F, 0.0F}};
  grid.AddScan(SE2(0.05, 0.05, 0.0), {.hits = hits, .no_returns = {}});
  return grid;
}

TEST(MapView, EnlargedCellsCoverTheirPixels) {
  Canvas canvas(101 * 8, 8);
  MapView view(&canvas, {0, 0, 101 * 8, 8}, Box(0.0, 0.0, 10.1, 0.1));
  view.DrawGrid(OneBeam(), kFree, kWallColor);
  EXPECT_EQ(Count(canvas, kFree), 100 * 8 * 8);
  EXPECT_EQ(Count(canvas, kWallColor), 8 * 8);
  EXPECT_EQ(canvas.At(100 * 8 + 7, 7), kWallColor);
  EXPECT_EQ(canvas.At(100 * 8 - 1, 0), kFree);
}

TEST(MapView, WallsSurviveShrinking) {
  Canvas canvas(20, 20);
  MapView view(&canvas, {0, 0, 20, 20}, Box(0.0, -10.0, 20.0, 10.0));
  view.DrawGrid(OneBeam(), kFree, kWallColor);
  EXPECT_EQ(canvas.At(10, 9), kWallColor);
  EXPECT_EQ(Count(canvas, kWallColor), 1);
  EXPECT_EQ(Count(canvas, kFree), 10);
}

TEST(MapView, SeenExtentIsTheOutlineOfTheCells) {
  const Eigen::AlignedBox2d extent = SeenExtent(OneBeam());
  EXPECT_TRUE(extent.min().isApprox(Eigen::Vector2d(0.0, 0.0)));
  EXPECT_TRUE(extent.max().isApprox(Eigen::Vector2d(10.1, 0.1)));
  EXPECT_TRUE(SeenExtent(OccupancyGrid()).isEmpty());
}

TEST(MapView, EllipseAxesAreSigmasLongInPixels) {
  for (double angle : {0.0, 0.5, 1.2, -0.8}) {
    Canvas canvas(800, 800);
    MapView view(&canvas, {0, 0, 800, 800}, Box(-20.0, -20.0, 20.0, 20.0));
    const Eigen::Matrix2d R = Eigen::Rotation2Dd(angle).toRotationMatrix();
    const Eigen::Matrix2d covariance =
        R * Eigen::Vector2d(4.0 * 4.0, 1.5 * 1.5).asDiagonal() * R.transpose();
    EXPECT_TRUE(view.DrawEllipse({0.0, 0.0}, covariance, 3.0, kInk, 1));
    // The picture's y axis points down.
    const Eigen::Vector2d major(R(0, 0), -R(1, 0));
    const Eigen::Vector2d minor(R(0, 1), -R(1, 1));
    EXPECT_NEAR(InkedExtent(canvas, major), 2.0 * 3.0 * 4.0 * 20.0, 2.0) << angle;
    EXPECT_NEAR(InkedExtent(canvas, minor), 2.0 * 3.0 * 1.5 * 20.0, 2.0) << angle;
  }
}

TEST(MapView, SingularCovarianceIsASegmentOrADot) {
  Canvas canvas(400, 400);
  MapView view(&canvas, {0, 0, 400, 400}, Box(-10.0, -10.0, 10.0, 10.0));
  EXPECT_TRUE(view.DrawEllipse({0.0, 0.0}, Eigen::Vector2d(4.0, 0.0).asDiagonal(), 3.0, kInk, 1));
  EXPECT_NEAR(InkedExtent(canvas, {1.0, 0.0}), 240.0, 2.0);
  EXPECT_LE(InkedExtent(canvas, {0.0, 1.0}), 2.0);
  EXPECT_TRUE(view.DrawEllipse({0.0, 0.0}, Eigen::Matrix2d::Zero(), 3.0, kInk, 1));
}

TEST(MapView, WhatIsNoCovarianceIsNotDrawn) {
  Canvas canvas(100, 100);
  MapView view(&canvas, {0, 0, 100, 100}, Box(-1.0, -1.0, 1.0, 1.0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(view.DrawEllipse({0.0, 0.0}, Eigen::Vector2d(nan, 1.0).asDiagonal(), 3.0, kInk, 1));
  EXPECT_FALSE(view.DrawEllipse({0.0, 0.0}, Eigen::Vector2d(-1.0, 1.0).asDiagonal(), 3.0, kInk, 1));
  EXPECT_FALSE(view.DrawEllipse({nan, 0.0}, Eigen::Matrix2d::Identity(), 3.0, kInk, 1));
  EXPECT_EQ(Count(canvas, kWhite), 100 * 100);
}

TEST(MapView, HugeEllipsesStayInsideTheArea) {
  Canvas canvas(100, 100);
  MapView view(&canvas, {20, 20, 60, 60}, Box(-1.0, -1.0, 1.0, 1.0));
  for (double variance : {1e2, 1e8, 1e30, 1e300}) {
    EXPECT_TRUE(
        view.DrawEllipse({0.0, 0.0}, Eigen::Vector2d(variance, 0.01).asDiagonal(), 3.0, kInk, 1));
  }
  EXPECT_NE(Count(canvas, kWhite), 100 * 100);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(canvas.At(10, i), kWhite);
}

TEST(MapView, ScaleBarIsAsLongAsItsRoundNumberOfMetres) {
  struct Case {
    double extent;
    double bar;
  };
  for (const Case& c : {Case{40.0, 10.0}, Case{100.0, 20.0}, Case{79.0, 10.0}, Case{0.9, 0.2}}) {
    Canvas canvas(800, 900);
    MapView view(&canvas, {0, 0, 800, 800}, Box(0.0, 0.0, c.extent, c.extent));
    view.DrawScaleBar(0, 850, 16);
    int length = 0;
    while (length < 800 && canvas.At(length, 848) == kBlack) ++length;
    EXPECT_NEAR(length, c.bar / c.extent * 800.0, 1.0) << c.extent;
  }
}

}  // namespace
}  // namespace loopgrid
