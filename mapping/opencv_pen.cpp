#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "mapping/pen.h"

namespace loopgrid {
namespace {

// OpenCV's drawing takes whole numbers of 1/16 pixel.
constexpr int kSubpixelBits = 4;
constexpr std::int64_t kSubpixels = 1 << kSubpixelBits;

// Coordinates are limited to this before they are rounded to integers; in subpixels.
constexpr double kFarthest = 1e9;

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kCapitalHeight = 21.0;  // of that font at scale 1, pixels

cv::Scalar ToScalar(Color color) { return {1.0 * color.red, 1.0 * color.green, 1.0 * color.blue}; }

cv::Mat ToMat(const PixelBlock& block) {
  return cv::Mat(block.height, block.width, CV_8UC3, block.first, block.row_bytes);
}

double FontScale(int height) { return height / kCapitalHeight; }

// Large letters get strokes of a tenth of their height.
int FontThickness(int height) { return std::max(1, height / 10); }

class CvPen : public Pen {
 public:
  void DrawLine(const PixelBlock& block, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                Color color, int thickness) const override {
    // Cut the line to the block, with a margin for the ends of thick lines. clipLine() computes
    // with 64 bits; line() does not, so far ends could overflow.
    const std::int64_t margin = kSubpixels * (2 + thickness);
    const auto to_point = [margin](const Eigen::Vector2d& p) {
      // OpenCV's (0, 0) is the middle of the first pixel.
      const Eigen::Vector2d scaled =
          (static_cast<double>(kSubpixels) * (p - Eigen::Vector2d(0.5, 0.5)))
              .cwiseMax(-kFarthest)
              .cwiseMin(kFarthest);
      return cv::Point2l(std::lround(scaled.x()) + margin, std::lround(scaled.y()) + margin);
    };
    cv::Point2l a = to_point(from);
    cv::Point2l b = to_point(to);
    const cv::Size2l size(kSubpixels * block.width + 2 * margin,
                          kSubpixels * block.height + 2 * margin);
    if (!cv::clipLine(size, a, b)) return;
    const cv::Point2l corner(margin, margin);
    cv::Mat image = ToMat(block);
    cv::line(image, cv::Point(a - corner), cv::Point(b - corner), ToScalar(color), thickness,
             cv::LINE_AA, kSubpixelBits);
  }

  void DrawText(const PixelBlock& block, int x, int y, int height, const std::string& text,
                Color color) const override {
    cv::Mat image = ToMat(block);
    cv::putText(image, text, {x, y}, kFont, FontScale(height), ToScalar(color),
                FontThickness(height), cv::LINE_AA);
  }

  int TextWidth(int height, const std::string& text) const override {
    return cv::getTextSize(text, kFont, FontScale(height), FontThickness(height), nullptr).width;
  }
};

}  // namespace

const Pen& OpenCvPen() {
  static const CvPen pen;
  return pen;
}

}  // namespace loopgrid
