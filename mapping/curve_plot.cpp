#include "mapping/curve_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "mapping/axis.h"
#include "mapping/canvas.h"

namespace loopgrid {
namespace {

// Pixels.
constexpr int kWidth = 1600;
constexpr int kPlotHeight = 900;
constexpr int kMargin = 30;
constexpr int kText = 20;
constexpr int kRow = 2 * kText;
constexpr int kTick = 12;
constexpr int kSampleWidth = 90;
constexpr double kMarkerRadius = 8.0;
constexpr int kMostMarkers = 30;

constexpr double kLogarithmicRange = 20.0;
constexpr Color kFrameColor{60, 60, 60};
constexpr Color kGridColor{225, 225, 225};

/// How a curve looks. Dashes are lengths in pixels, drawn and left out in turn.
struct Style {
  Color color;
  std::vector<double> dashes;
  int marker_corners;
  double marker_angle;  // of its first corner, radians
};

Style StyleOf(std::size_t curve) {
  constexpr double kUp = 0.5 * std::numbers::pi;
  constexpr double kDiagonal = 0.25 * std::numbers::pi;
  static const std::vector<Style> kStyles = {
      {{0, 80, 160}, {}, 24, 0.0},              // circle
      {{225, 95, 0}, {18, 9}, 4, kDiagonal},    // square
      {{0, 130, 90}, {4, 7}, 3, kUp},           // triangle
      {{150, 50, 130}, {18, 7, 4, 7}, 4, kUp},  // diamond
      {{110, 110, 110}, {30, 10}, 3, -kUp},     // triangle upside down
      {{120, 75, 20}, {8, 5}, 5, kUp},          // pentagon
  };
  return kStyles[curve % kStyles.size()];
}

bool IsFinite(const Eigen::Vector2d& point) { return point.allFinite(); }

/// Draws a line through points. The dashes continue from one segment to the next.
void DrawPolyline(const std::vector<Eigen::Vector2d>& points, const Style& style, Canvas* canvas) {
  constexpr int kThickness = 3;
  const PixelArea everywhere{0, 0, canvas->width(), canvas->height()};
  std::size_t dash = 0;
  double left = style.dashes.empty() ? 0.0 : style.dashes.front();
  for (std::size_t i = 1; i < points.size(); ++i) {
    Eigen::Vector2d position = points[i - 1];
    double rest = (points[i] - position).norm();
    if (style.dashes.empty()) canvas->DrawLine(everywhere, position, points[i], style.color, 3);
    while (!style.dashes.empty() && rest > 0.0) {
      const double length = std::min(left, rest);
      const Eigen::Vector2d end = position + length / rest * (points[i] - position);
      if (dash % 2 == 0) canvas->DrawLine(everywhere, position, end, style.color, kThickness);
      position = end;
      rest -= length;
      left -= length;
      if (left > 0.0) continue;
      dash = (dash + 1) % style.dashes.size();
      left = style.dashes[dash];
    }
  }
}

void DrawMarker(const Eigen::Vector2d& centre, const Style& style, Canvas* canvas) {
  const PixelArea everywhere{0, 0, canvas->width(), canvas->height()};
  const auto corner = [&](int k) -> Eigen::Vector2d {
    const double angle = style.marker_angle + 2.0 * std::numbers::pi * k / style.marker_corners;
    return centre + kMarkerRadius * Eigen::Vector2d(std::cos(angle), -std::sin(angle));
  };
  canvas->DrawLine(everywhere, centre, centre, kWhite, static_cast<int>(1.4 * kMarkerRadius));
  for (int k = 0; k < style.marker_corners; ++k) {
    canvas->DrawLine(everywhere, corner(k), corner(k + 1), style.color, 2);
  }
}

struct Range {
  double lowest = 0.0;
  double highest = 1.0;
};

Range RangeOf(std::span<const Curve> curves, int coordinate, bool positive_only) {
  std::vector<double> values;
  for (const Curve& curve : curves) {
    for (const Eigen::Vector2d& point : curve.points) {
      if (!IsFinite(point) || (positive_only && point[coordinate] <= 0.0)) continue;
      values.push_back(point[coordinate]);
    }
  }
  if (values.empty()) return {};
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  return {*lowest, *highest};
}

Axis AxisOf(std::span<const Curve> curves) {
  const Range positive = RangeOf(curves, 1, true);
  const bool is_logarithmic =
      positive.lowest > 0.0 && positive.highest / positive.lowest > kLogarithmicRange;
  const Range range = is_logarithmic ? positive : RangeOf(curves, 1, false);
  return Axis(range.lowest, range.highest, is_logarithmic);
}

constexpr int kExponentText = kText * 3 / 4;

int WidthOf(const AxisTick& tick) {
  return Canvas::TextWidth(kText, tick.label) + Canvas::TextWidth(kExponentText, tick.exponent);
}

void DrawLabel(int left, int base, const AxisTick& tick, Canvas* canvas) {
  canvas->DrawText(left, base, kText, tick.label, kBlack);
  canvas->DrawText(left + Canvas::TextWidth(kText, tick.label), base - kText * 2 / 3, kExponentText,
                   tick.exponent, kBlack);
}

/// The frame with its ticks, and what is needed to find a point in it.
class Frame {
 public:
  Frame(const Axis& x, const Axis& y, int top, Canvas* canvas)
      : x_(x), y_(y), x_ticks_(x.Ticks(10)), y_ticks_(y.Ticks(10)), canvas_(canvas) {
    int widest = 0;
    for (const AxisTick& tick : y_ticks_) widest = std::max(widest, WidthOf(tick));
    const int left = kMargin + widest + kTick;
    area_ = {left, top, kWidth - kMargin - left, kPlotHeight};
  }

  Eigen::Vector2d ToPixel(const Eigen::Vector2d& point) const {
    return {area_.left + area_.width * x_.Position(point.x()),
            area_.top + area_.height * (1.0 - y_.Position(point.y()))};
  }

  void Draw(const std::string& x_label, const std::string& y_label) {
    const int bottom = area_.top + area_.height;
    const int right = area_.left + area_.width;
    for (const AxisTick& tick : x_ticks_) {
      const int x =
          static_cast<int>(std::lround(area_.left + area_.width * x_.Position(tick.value)));
      canvas_->FillRectangle({x, area_.top, 1, area_.height}, kGridColor);
      canvas_->FillRectangle({x, bottom - kTick, 2, kTick}, kFrameColor);
      DrawLabel(x - WidthOf(tick) / 2, bottom + kText + kTick, tick, canvas_);
    }
    for (const AxisTick& tick : y_ticks_) {
      const int y =
          static_cast<int>(std::lround(area_.top + area_.height * (1.0 - y_.Position(tick.value))));
      const bool is_labelled = !tick.label.empty();
      if (is_labelled) canvas_->FillRectangle({area_.left, y, area_.width, 1}, kGridColor);
      canvas_->FillRectangle({area_.left, y, is_labelled ? kTick : kTick / 2, 2}, kFrameColor);
      DrawLabel(area_.left - kTick - WidthOf(tick), y + kText / 2, tick, canvas_);
    }
    canvas_->FillRectangle({area_.left, area_.top, 2, area_.height}, kFrameColor);
    canvas_->FillRectangle({area_.left, bottom, area_.width, 2}, kFrameColor);
    canvas_->DrawText(area_.left, area_.top - kText, kText, y_label, kBlack);
    canvas_->DrawText(right - Canvas::TextWidth(kText, x_label), bottom + 2 * kRow, kText, x_label,
                      kBlack);
  }

 private:
  const Axis& x_;
  const Axis& y_;
  std::vector<AxisTick> x_ticks_;
  std::vector<AxisTick> y_ticks_;
  PixelArea area_;
  Canvas* canvas_;
};

void DrawCurve(const Curve& curve, const Style& style, const Frame& frame, Canvas* canvas) {
  std::vector<Eigen::Vector2d> pixels;
  for (const Eigen::Vector2d& point : curve.points) {
    if (IsFinite(point)) pixels.push_back(frame.ToPixel(point));
  }
  DrawPolyline(pixels, style, canvas);
  const std::size_t stride = pixels.size() / kMostMarkers + 1;
  for (std::size_t i = 0; i < pixels.size(); i += stride) DrawMarker(pixels[i], style, canvas);
}

void DrawLegend(std::span<const Curve> curves, Canvas* canvas) {
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const int base = kMargin + static_cast<int>(i + 1) * kRow - kText / 2;
    const double middle = base - 0.5 * kText;
    const Style style = StyleOf(i);
    DrawPolyline({{1.0 * kMargin, middle}, {1.0 * kMargin + kSampleWidth, middle}}, style, canvas);
    DrawMarker({kMargin + 0.5 * kSampleWidth, middle}, style, canvas);
    canvas->DrawText(kMargin + kSampleWidth + kText, base, kText, curves[i].name, kBlack);
  }
}

}  // namespace

std::string DrawCurves(std::span<const Curve> curves, const std::string& x_label,
                       const std::string& y_label) {
  const int top = kMargin + static_cast<int>(curves.size()) * kRow + 2 * kRow;
  Canvas canvas(kWidth, top + kPlotHeight + 2 * kRow + kMargin);
  const Range x_range = RangeOf(curves, 0, false);
  const Axis x(x_range.lowest, x_range.highest, false);
  const Axis y = AxisOf(curves);
  Frame frame(x, y, top, &canvas);
  frame.Draw(x_label, y_label);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    DrawCurve(curves[i], StyleOf(i), frame, &canvas);
  }
  DrawLegend(curves, &canvas);
  return canvas.EncodePng();
}

}  // namespace loopgrid
