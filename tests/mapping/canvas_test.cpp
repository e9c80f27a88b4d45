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

TEST(Canvas, FineLinesLeaveTheirShareOfColourInEachColumn) {
  for (double dy : {0.0, 0.3, 3.0, 9.9}) {
    Canvas canvas(40, 40);
    canvas.DrawFineLine({0, 0, 40, 40}, {5.0, 20.2}, {35.0, 20.2 + dy}, kBlack, 0.5);
    for (int x = 6; x < 34; ++x) {
      int ink = 0;
      for (int y = 0; y < 40; ++y) ink += 255 - canvas.At(x, y).green;
      EXPECT_NEAR(ink, 0.5 * 255, 2) << x << ", " << dy;
    }
    EXPECT_EQ(CountNotWhite(canvas, {0, 0, 5, 40}) + CountNotWhite(canvas, {35, 0, 5, 40}), 0);
  }
}

TEST(Canvas, FineLinesAddUpWhereTheyMeet) {
  Canvas canvas(20, 20);
  const auto draw = [&] {
    canvas.DrawFineLine({0, 0, 20, 20}, {10.5, 2.0}, {10.5, 18.0}, kBlack, 0.5);
    return canvas.At(10, 10).red;
  };
  EXPECT_EQ(draw(), 128);
  EXPECT_EQ(draw(), 64);
}

TEST(Canvas, FineLinesAreCutAtTheAreaHoweverFarTheyGo) {
  constexpr PixelArea kArea{10, 10, 20, 20};
  for (double far : {1e2, 1e6, 1e12, 1e300}) {
    for (bool upright : {false, true}) {
      Canvas canvas(40, 40);
      const Eigen::Vector2d way = upright ? Eigen::Vector2d(0.0, far) : Eigen::Vector2d(far, 0.0);
      const Eigen::Vector2d middle(20.5, 20.5);
      canvas.DrawFineLine(kArea, middle - way, middle + way, kRed, 1.0);
      EXPECT_EQ(canvas.At(20, 20), kRed) << far;
      EXPECT_EQ(CountNotWhite(canvas, {0, 0, 40, 40}), 20) << far;
    }
  }
}

TEST(Canvas, FineLinesThatMissTheAreaOrAreNotFiniteLeaveNothing) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Canvas canvas(20, 20);
  const PixelArea all{0, 0, 20, 20};
  canvas.DrawFineLine(all, {-5.0, 3.0}, {-5.0, 9.0}, kRed, 1.0);
  canvas.DrawFineLine(all, {-5.0, 3.0}, {3.0, -9.0}, kRed, 1.0);
  canvas.DrawFineLine(all, {kNan, 3.0}, {3.0, 9.0}, kRed, 1.0);
  canvas.DrawFineLine(all, {1.0, 3.0}, {kInfinity, 9.0}, kRed, 1.0);
  EXPECT_EQ(CountNotWhite(canvas, all), 0);
  canvas.DrawFineLine(all, {7.5, 8.5}, {7.5, 8.5}, kRed, 1.0);
  EXPECT_EQ(canvas.At(7, 8), kRed);
  EXPECT_EQ(CountNotWhite(canvas, all), 1);
}

}  // namespace
}  // namespace loopgrid
