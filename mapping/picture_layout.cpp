#include "mapping/picture_layout.h"

#include <algorithm>
#include <cmath>

namespace loopgrid {
namespace {

int DrawLegendText(int left, int base, const std::string& text, Canvas* canvas) {
  constexpr int kGap = kTextHeight / 2;
  canvas->DrawText(left + kGap, base, kTextHeight, text, kBlack);
  return left + kGap + Canvas::TextWidth(kTextHeight, text) + 2 * kTextHeight;
}

}  // namespace

Eigen::Vector2i FittedSize(const Eigen::AlignedBox2d& extent, int max_width, int max_height) {
  const Eigen::Vector2d size =
      extent.isEmpty() ? Eigen::Vector2d(1.0, 1.0) : extent.sizes().cwiseMax(1e-6);
  const double scale = std::min(max_width / size.x(), max_height / size.y());
  return (scale * size).array().ceil().cast<int>().matrix();
}

int DrawLegendLine(int left, int base, Color color, int thickness, const std::string& text,
                   Canvas* canvas) {
  constexpr int kSample = 60;
  canvas->FillRectangle({left, base - kTextHeight / 2 - thickness / 2, kSample, thickness}, color);
  return DrawLegendText(left + kSample, base, text, canvas);
}

int DrawLegendDot(int left, int base, Color color, double radius, const std::string& text,
                  Canvas* canvas) {
  const int width = static_cast<int>(std::ceil(2.0 * radius));
  const Eigen::Vector2d centre(left + radius, base - 0.5 * kTextHeight);
  canvas->DrawLine({0, 0, canvas->width(), canvas->height()}, centre, centre, color, width);
  return DrawLegendText(left + width, base, text, canvas);
}

}  // namespace loopgrid
