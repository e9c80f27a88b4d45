#include "mapping/picture_layout.h"

#include <algorithm>

namespace loopgrid {

Eigen::Vector2i FittedSize(const Eigen::AlignedBox2d& extent, int max_width, int max_height) {
  const Eigen::Vector2d size =
      extent.isEmpty() ? Eigen::Vector2d(1.0, 1.0) : extent.sizes().cwiseMax(1e-6);
  const double scale = std::min(max_width / size.x(), max_height / size.y());
  return (scale * size).array().ceil().cast<int>().matrix();
}

int DrawLegendEntry(int left, int base, Color color, int thickness, const std::string& text,
                    Canvas* canvas) {
  constexpr int kSample = 60;
  canvas->FillRectangle({left, base - kTextHeight / 2 - thickness / 2, kSample, thickness}, color);
  canvas->DrawText(left + kSample + kTextHeight / 2, base, kTextHeight, text, kBlack);
  return left + kSample + 3 * kTextHeight + Canvas::TextWidth(kTextHeight, text);
}

}  // namespace loopgrid
