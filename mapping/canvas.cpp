#include "mapping/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace loopgrid {
namespace {

// OpenCV's drawing takes whole numbers of 1/16 pixel.
constexpr int kSubpixelBits = 4;
constexpr std::int64_t kSubpixels = 1 << kSubpixelBits;

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kCapitalHeight = 21.0;  // of that font at scale 1, pixels

cv::Scalar ToScalar(Color color) { return {1.0 * color.blue, 1.0 * color.green, 1.0 * color.red}; }

cv::Rect ToRect(const PixelArea& area) { return {area.left, area.top, area.width, area.height}; }

double FontScale(int height) { return height / kCapitalHeight; }

// Strokes as thick as the letters are high ask for.
int FontThickness(int height) { return std::max(1, height / 10); }

}  // namespace

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
    // To OpenCV (0, 0) is the middle of the first pixel. Nothing sane is farther than 1e9.
    const Eigen::Vector2d inside = p - Eigen::Vector2d(area.left + 0.5, area.top + 0.5);
    const Eigen::Vector2d scaled =
        (static_cast<double>(kSubpixels) * inside).cwiseMax(-1e9).cwiseMin(1e9);
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
