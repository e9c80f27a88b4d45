#include "mapping/canvas.h"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <vector>

namespace loopgrid {
namespace {

constexpr Color kRed{200, 10, 20};

int CountNotWhite(const Canvas& canvas, const PixelArea& area) {
  int count = 0;
  for (int y = area.top; y < area.top + area.height; ++y) {
    for (int x = area.left; x < area.left + area.width; ++x) count += canvas.At(x, y) != kWhite;
  }
  return count;
}

TEST(Canvas, StartsWhite) {
  const Canvas canvas(7, 5);
  EXPECT_EQ(canvas.width(), 7);
  EXPECT_EQ(canvas.height(), 5);
  EXPECT_EQ(CountNotWhite(canvas, {0, 0, 7, 5}), 0);
}

TEST(Canvas, LinesGoThroughThePixelsThatTheirPointsAreIn) {
  Canvas canvas(20, 20);
  canvas.DrawLine({0, 0, 20, 20}, {2.5, 10.5}, {15.5, 10.5}, kRed, 1);
  // Thin lines are a little paler than their colour.
  EXPECT_LT(canvas.At(3, 10).green, 60);
  EXPECT_LT(canvas.At(14, 10).green, 60);
  EXPECT_EQ(canvas.At(8, 7), kWhite);
  EXPECT_EQ(canvas.At(8, 13), kWhite);
  EXPECT_EQ(canvas.At(18, 10), kWhite);
}

TEST(Canvas, LinesAreCutAtTheAreaHoweverFarTheyGo) {
  constexpr PixelArea kArea{10, 10, 20, 20};
  for (double far : {1e2, 1e6, 1e12, 1e300}) {
    Canvas canvas(40, 40);
    canvas.DrawLine(kArea, {-far, 20.5}, {far, 20.5}, kRed, 3);
    EXPECT_EQ(canvas.At(10, 20), kRed) << far;
    EXPECT_EQ(canvas.At(29, 20), kRed) << far;
    EXPECT_EQ(CountNotWhite(canvas, {0, 0, 40, 40}), CountNotWhite(canvas, kArea)) << far;
  }
}

TEST(Canvas, LinesOutsideOfTheAreaOrWithoutAPlaceAreNotDrawn) {
  Canvas canvas(40, 40);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  canvas.DrawLine({10, 10, 20, 20}, {0.0, 2.0}, {40.0, 2.0}, kRed, 1);
  canvas.DrawLine({0, 0, 40, 40}, {nan, 2.0}, {40.0, 2.0}, kRed, 1);
  canvas.DrawLine({0, 0, 40, 40}, {0.0, 2.0}, {infinity, 2.0}, kRed, 1);
  EXPECT_EQ(CountNotWhite(canvas, {0, 0, 40, 40}), 0);
}

TEST(Canvas, RectanglesFillTheirPixels) {
  Canvas canvas(20, 20);
  canvas.FillRectangle({3, 4, 5, 6}, kRed);
  EXPECT_EQ(CountNotWhite(canvas, {3, 4, 5, 6}), 30);
  EXPECT_EQ(CountNotWhite(canvas, {0, 0, 20, 20}), 30);
}

TEST(Canvas, TextIsAsWideAsItSays) {
  Canvas canvas(300, 60);
  canvas.DrawText(10, 40, 20, "10 m", kBlack);
  const int width = Canvas::TextWidth(20, "10 m");
  EXPECT_GT(CountNotWhite(canvas, {10, 18, width, 24}), 100);
  EXPECT_EQ(CountNotWhite(canvas, {10 + width + 4, 0, 300 - 14 - width, 60}), 0);
}

TEST(Canvas, PngHoldsItsPixels) {
  Canvas canvas(6, 4);
  canvas.SetPixel(2, 1, kRed);
  const std::string bytes = canvas.EncodePng();
  const cv::Mat image =
      cv::imdecode(std::vector<unsigned char>(bytes.begin(), bytes.end()), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(image.size(), cv::Size(6, 4));
  EXPECT_EQ(image.at<cv::Vec3b>(1, 2), cv::Vec3b(kRed.blue, kRed.green, kRed.red));
  EXPECT_EQ(image.at<cv::Vec3b>(0, 0), cv::Vec3b(255, 255, 255));
}

}  // namespace
}  // namespace loopgrid
