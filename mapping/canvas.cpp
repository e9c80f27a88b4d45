#include "mapping/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

namespace loopgrid {
namespace {

// OpenCV's drawing takes whole numbers of 1/16 pixel.
constexpr int kSubpixelBits = 4;
constexpr std::int64_t kSubpixels = 1 << kSubpixelBits;

// No sane point is farther from the picture; in subpixels or pixels.
constexpr double kFarthest = 1e9;

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kCapitalHeight = 21.0;  // of that font at scale 1, pixels

cv::Scalar ToScalar(Color color) { return {1.0 * color.blue, 1.0 * color.green, 1.0 * color.red}; }

cv::Rect ToRect(const PixelArea& area) { return {area.left, area.top, area.width, area.height}; }

double FontScale(int height) { return height / kCapitalHeight; }

// Strokes as thick as the letters are high ask for.
int FontThickness(int height) { return std::max(1, height / 10); }

std::uint8_t Mix(std::uint8_t a, std::uint8_t b, double share) {
  return static_cast<std::uint8_t>(std::lround(a + share * (b - a)));
}

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

Color Mix(Color a, Color b, double share) {
  return {Mix(a.red, b.red, share), Mix(a.green, b.green, share), Mix(a.blue, b.blue, share)};
}

Canvas::Canvas(int width, int height)
    : image_(std::make_unique<cv::Mat>(height, width, CV_8UC3, ToScalar(kWhite))) {}
Canvas::~Canvas() = default;
Canvas::Canvas(Canvas&&) noexcept = default;
Canvas& Canvas::operator=(Canvas&&) noexcept = default;

int Canvas::width() const { return image_->cols; }
int Canvas::height() const { return image_->rows; }

Color Canvas::At(int x, int y) const {
  const auto& pixel = image_->at<cv::Vec3b>(y, x);
  return {pixel[2], pixel[1], pixel[0]};
}

void Canvas::SetPixel(int x, int y, Color color) {
  image_->at<cv::Vec3b>(y, x) = {color.blue, color.green, color.red};
}

void Canvas::DrawLine(const PixelArea& area, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                      Color color, int thickness) {
  if (!from.allFinite() || !to.allFinite()) return;
  // Cut to the area with a margin for the ends of thick lines. clipLine() does it in 64 bits, which
  // line() would not.
  const std::int64_t margin = kSubpixels * (2 + thickness);
  const auto to_point = [&area, margin](const Eigen::Vector2d& p) {
    // To OpenCV (0, 0) is the middle of the first pixel.
    const Eigen::Vector2d inside = p - Eigen::Vector2d(area.left + 0.5, area.top + 0.5);
    const Eigen::Vector2d scaled =
        (static_cast<double>(kSubpixels) * inside).cwiseMax(-kFarthest).cwiseMin(kFarthest);
    return cv::Point2l(std::lround(scaled.x()) + margin, std::lround(scaled.y()) + margin);
  };
  cv::Point2l a = to_point(from);
  cv::Point2l b = to_point(to);
  const cv::Size2l size(kSubpixels * area.width + 2 * margin,
                        kSubpixels * area.height + 2 * margin);
  if (!cv::clipLine(size, a, b)) return;
  const cv::Point2l corner(margin, margin);
  cv::Mat part = (*image_)(ToRect(area));
  cv::line(part, cv::Point(a - corner), cv::Point(b - corner), ToScalar(color), thickness,
           cv::LINE_AA, kSubpixelBits);
}

void Canvas::DrawFineLine(const PixelArea& area, const Eigen::Vector2d& from,
                          const Eigen::Vector2d& to, Color color, double opacity) {
  const Eigen::Vector2d corner(area.left, area.top);
  if (!from.allFinite() || !to.allFinite()) return;
  Eigen::Vector2d a = (from - corner).cwiseMax(-kFarthest).cwiseMin(kFarthest);
  Eigen::Vector2d b = (to - corner).cwiseMax(-kFarthest).cwiseMin(kFarthest);
  if (!Clip(area.width, area.height, &a, &b)) return;
  // Along the longer axis a pixel a step; across it, two pixels share the colour (Wu 1991).
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
  (*image_)(ToRect(area)).setTo(ToScalar(color));
}

void Canvas::DrawText(int x, int y, int height, const std::string& text, Color color) {
  cv::putText(*image_, text, {x, y}, kFont, FontScale(height), ToScalar(color),
              FontThickness(height), cv::LINE_AA);
}

int Canvas::TextWidth(int height, const std::string& text) {
  return cv::getTextSize(text, kFont, FontScale(height), FontThickness(height), nullptr).width;
}

std::string Canvas::EncodePng() const {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", *image_, bytes, {cv::IMWRITE_PNG_COMPRESSION, 6});
  return {bytes.begin(), bytes.end()};
}

}  // namespace loopgrid
