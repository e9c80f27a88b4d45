#include "mapping/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "mapping/png_encoder.h"

namespace loopgrid {
namespace {

constexpr int kChannels = 3;

// Coordinates are limited to this before they are rounded to integers; in pixels.
constexpr double kFarthest = 1e9;

// Cuts the segment to 0 <= x < width, 0 <= y < height (Liang and Barsky 1984); false if nothing is
// left of it.
bool Clip(double width, double height, Eigen::Vector2d* from, Eigen::Vector2d* to) {
  const Eigen::Vector2d start = *from;
  const Eigen::Vector2d way = *to - start;
  const Eigen::Vector2d size(width, height);
  double enter = 0.0;
  double leave = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    if (way[axis] == 0.0) {
      if (start[axis] < 0.0 || start[axis] > size[axis]) return false;
      continue;
    }
    const double at_zero = -start[axis] / way[axis];
    const double at_size = (size[axis] - start[axis]) / way[axis];
    enter = std::max(enter, std::min(at_zero, at_size));
    leave = std::min(leave, std::max(at_zero, at_size));
  }
  if (enter > leave) return false;
  *from = start + enter * way;
  *to = start + leave * way;
  return true;
}

}  // namespace

Canvas::Canvas(int width, int height)
    : width_(width),
      height_(height),
      pixels_(kChannels * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 255) {
}

const std::uint8_t* Canvas::PixelAt(int x, int y) const {
  return pixels_.data() +
         kChannels * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                      static_cast<std::size_t>(x));
}

std::uint8_t* Canvas::PixelAt(int x, int y) {
  return const_cast<std::uint8_t*>(std::as_const(*this).PixelAt(x, y));
}

PixelBlock Canvas::Block(const PixelArea& area) {
  return {.first = PixelAt(area.left, area.top),
          .width = area.width,
          .height = area.height,
          .row_bytes = kChannels * static_cast<std::size_t>(width_)};
}

Color Canvas::At(int x, int y) const {
  const std::uint8_t* pixel = PixelAt(x, y);
  return {pixel[0], pixel[1], pixel[2]};
}

void Canvas::SetPixel(int x, int y, Color color) {
  std::uint8_t* pixel = PixelAt(x, y);
  pixel[0] = color.red;
  pixel[1] = color.green;
  pixel[2] = color.blue;
}

void Canvas::DrawLine(const PixelArea& area, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                      Color color, int thickness) {
  if (!from.allFinite() || !to.allFinite()) return;
  const Eigen::Vector2d corner(area.left, area.top);
  DrawingPen().DrawLine(Block(area), from - corner, to - corner, color, thickness);
}

void Canvas::DrawFineLine(const PixelArea& area, const Eigen::Vector2d& from,
                          const Eigen::Vector2d& to, Color color, double opacity) {
  const Eigen::Vector2d corner(area.left, area.top);
  if (!from.allFinite() || !to.allFinite()) return;
  Eigen::Vector2d a = (from - corner).cwiseMax(-kFarthest).cwiseMin(kFarthest);
  Eigen::Vector2d b = (to - corner).cwiseMax(-kFarthest).cwiseMin(kFarthest);
  if (!Clip(area.width, area.height, &a, &b)) return;
  // Each step goes one pixel along the longer axis. Two pixels across it share the colour (Wu
  // 1991).
  const int along = std::abs(b.x() - a.x()) >= std::abs(b.y() - a.y()) ? 0 : 1;
  const int across = 1 - along;
  if (a[along] > b[along]) std::swap(a, b);
  const double length = b[along] - a[along];
  const double slope = length > 0.0 ? (b[across] - a[across]) / length : 0.0;
  const auto blend = [&](int i, int j, double share) {
    const int x = along == 0 ? i : j;
    const int y = along == 0 ? j : i;
    if (x < 0 || y < 0 || x >= area.width || y >= area.height) return;
    SetPixel(area.left + x, area.top + y,
             Mix(At(area.left + x, area.top + y), color, share * opacity));
  };
  const int first = static_cast<int>(std::floor(a[along]));
  const int end = std::max(first + 1, static_cast<int>(std::ceil(b[along])));
  for (int i = first; i < end; ++i) {
    const double middle = std::clamp(i + 0.5, a[along], b[along]);
    const double position = a[across] + slope * (middle - a[along]) - 0.5;
    const int j = static_cast<int>(std::floor(position));
    const double below = position - j;
    blend(i, j, 1.0 - below);
    blend(i, j + 1, below);
  }
}

void Canvas::FillRectangle(const PixelArea& area, Color color) {
  for (int y = area.top; y < area.top + area.height; ++y) {
    for (int x = area.left; x < area.left + area.width; ++x) SetPixel(x, y, color);
  }
}

void Canvas::DrawText(int x, int y, int height, const std::string& text, Color color) {
  DrawingPen().DrawText(Block({0, 0, width_, height_}), x, y, height, text, color);
}

int Canvas::TextWidth(int height, const std::string& text) {
  return DrawingPen().TextWidth(height, text);
}

std::string Canvas::EncodePng() const {
  return loopgrid::EncodePng(width_, height_, PixelFormat::kRedGreenBlue, pixels_);
}

}  // namespace loopgrid
