#include "mapping/curve_plot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "tests/mapping/drawing_testing.h"

namespace loopgrid {
namespace {

using test_support::Count;
using test_support::Decode;
using test_support::Mask;

constexpr Color kFirst{0, 80, 160};
constexpr Color kSecond{225, 95, 0};
constexpr int kLegendEnd = 200;  // a legend of two is above

Curve Falling(const std::string& name, double from, double ratio, int count) {
  Curve curve{name, {}};
  for (int i = 0; i < count; ++i) curve.points.emplace_back(i, from * std::pow(ratio, i));
  return curve;
}

cv::Rect InkOf(const cv::Mat& image, Color color) {
  std::vector<cv::Point> ink;
  cv::findNonZero(Mask(image.rowRange(kLegendEnd, image.rows), color), ink);
  return cv::boundingRect(ink);
}

TEST(DrawCurves, ShowsEachCurveInItsColour) {
  const std::vector<Curve> curves = {Falling("one", 100.0, 0.9, 10), Falling("two", 80.0, 0.95, 5)};
  const std::string png = DrawCurves(curves, "x", "y");
  const cv::Mat image = Decode(png);
  EXPECT_EQ(image.cols, 1600);
  const cv::Rect first = InkOf(image, kFirst);
  const cv::Rect second = InkOf(image, kSecond);
  EXPECT_GT(first.width, 1300);
  EXPECT_NEAR(second.width, first.width * 4.0 / 9.0, 30.0);
  EXPECT_EQ(png, DrawCurves(curves, "x", "y"));
}

TEST(DrawCurves, IsLogarithmicWhereTheRangeIsLarge) {
  // On a logarithmic axis the middle value of a geometric sequence is in the middle.
  const auto middle_of = [](double ratio) {
    const Curve all = Falling("all", 1000.0, ratio, 3);
    const Curve middle{"middle", {all.points[1]}};
    const cv::Mat image = Decode(DrawCurves(std::vector<Curve>{all, middle}, "x", "y"));
    const cv::Rect curve = InkOf(image, kFirst);
    const cv::Rect marker = InkOf(image, kSecond);
    return (marker.y + 0.5 * marker.height - curve.y) / curve.height;
  };
  EXPECT_NEAR(middle_of(0.1), 0.5, 0.02);
  // 1000, 300, 90: linear.
  EXPECT_NEAR(middle_of(0.3), (1000.0 - 300.0) / (1000.0 - 90.0), 0.02);
}

TEST(DrawCurves, PutsZeroAtTheLowerEndOfALogarithmicAxis) {
  Curve curve = Falling("a", 1e6, 0.01, 4);
  const cv::Rect without = InkOf(Decode(DrawCurves({{curve}}, "x", "y")), kFirst);
  curve.points.emplace_back(4.0, 0.0);
  const cv::Rect with = InkOf(Decode(DrawCurves({{curve}}, "x", "y")), kFirst);
  EXPECT_GT(with.y + with.height, without.y + without.height + 10);
}

TEST(DrawCurves, DrawsWhatLittleThereIs) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(Decode(DrawCurves({}, "x", "y")).empty());
  EXPECT_FALSE(Decode(DrawCurves({{Curve{"none", {}}}}, "x", "y")).empty());
  const cv::Mat zeros = Decode(DrawCurves({{Curve{"a", {{0.0, 0.0}, {1.0, 0.0}}}}}, "x", "y"));
  EXPECT_GT(InkOf(zeros, kFirst).width, 1000);
  const Curve broken{"a", {{0.0, 1.0}, {1.0, kInfinity}, {2.0, 3.0}}};
  EXPECT_GT(InkOf(Decode(DrawCurves({{broken}}, "x", "y")), kFirst).width, 1000);
}

TEST(DrawCurves, ColoursDifferInBrightnessAndThereIsAStyleForAnyNumberOfCurves) {
  std::vector<Curve> curves;
  for (int i = 0; i < 14; ++i) curves.push_back(Falling("curve", 100.0 + 10.0 * i, 0.9, 10));
  EXPECT_EQ(Decode(DrawCurves(curves, "x", "y")).cols, 1600);
  const auto brightness = [](Color c) { return 0.3 * c.red + 0.59 * c.green + 0.11 * c.blue; };
  EXPECT_GT(std::abs(brightness(kFirst) - brightness(kSecond)), 50.0);
}

}  // namespace
}  // namespace loopgrid
