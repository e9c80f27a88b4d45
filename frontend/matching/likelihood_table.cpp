#include "frontend/matching/likelihood_table.h"

#include <algorithm>
#include <cmath>

namespace loopgrid {

LikelihoodTable::LikelihoodTable(std::span<const Eigen::Vector2f> points,
                                 const Eigen::Vector2f& lower, const Eigen::Vector2f& upper,
                                 int margin, float resolution, float sigma, int levels)
    : resolution_(resolution),
      inverse_resolution_(1.0F / resolution),
      origin_(lower - Eigen::Vector2f::Constant(static_cast<float>(margin) * resolution)),
      width_(static_cast<int>((upper.x() - lower.x()) / resolution) + 1 + 2 * margin),
      height_(static_cast<int>((upper.y() - lower.y()) / resolution) + 1 + 2 * margin) {
  levels_.emplace_back(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);
  Rasterize(points, sigma);
  BuildPyramid(levels);
}

// Stamps a kernel around the cell of each point.
void LikelihoodTable::Rasterize(std::span<const Eigen::Vector2f> points, float sigma) {
  const int reach = static_cast<int>(std::ceil(3.0F * sigma / resolution_));
  const int side = 2 * reach + 1;
  std::vector<std::uint8_t> kernel(static_cast<std::size_t>(side * side));
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const float squared = static_cast<float>(x * x + y * y) * resolution_ * resolution_;
      kernel[static_cast<std::size_t>((y + reach) * side + x + reach)] = static_cast<std::uint8_t>(
          std::lround(255.0F * std::exp(-0.5F * squared / (sigma * sigma))));
    }
  }
  std::uint8_t* cells = levels_.front().data();
  for (const Eigen::Vector2f& p : points) {
    const Eigen::Vector2i c = CellOf(p);
    const int first_x = std::max(c.x() - reach, 0);
    const int last_x = std::min(c.x() + reach, width_ - 1);
    const int first_y = std::max(c.y() - reach, 0);
    const int last_y = std::min(c.y() + reach, height_ - 1);
    for (int y = first_y; y <= last_y; ++y) {
      std::uint8_t* row = cells + static_cast<std::ptrdiff_t>(y) * width_;
      const std::uint8_t* stamp = kernel.data() + (y - c.y() + reach) * side - c.x() + reach;
      for (int x = first_x; x <= last_x; ++x) row[x] = std::max(row[x], stamp[x]);
    }
  }
}

// Doubling: the maximum over 2^k cells is the larger of two maxima over 2^(k-1).
void LikelihoodTable::BuildPyramid(int levels) {
  const auto size = levels_.front().size();
  std::vector<std::uint8_t> rows(size);
  for (int k = 1; k < levels; ++k) {
    const int shift = 1 << (k - 1);
    const std::vector<std::uint8_t>& below = levels_.back();
    for (int y = 0; y < height_; ++y) {
      const std::uint8_t* in = below.data() + static_cast<std::ptrdiff_t>(y) * width_;
      std::uint8_t* out = rows.data() + static_cast<std::ptrdiff_t>(y) * width_;
      const int both = std::max(width_ - shift, 0);
      for (int x = 0; x < both; ++x) out[x] = std::max(in[x], in[x + shift]);
      for (int x = both; x < width_; ++x) out[x] = in[x];
    }
    std::vector<std::uint8_t> level(size);
    for (int y = 0; y < height_; ++y) {
      const std::uint8_t* a = rows.data() + static_cast<std::ptrdiff_t>(y) * width_;
      const std::uint8_t* b =
          y + shift < height_ ? a + static_cast<std::ptrdiff_t>(shift) * width_ : a;
      std::uint8_t* out = level.data() + static_cast<std::ptrdiff_t>(y) * width_;
      for (int x = 0; x < width_; ++x) out[x] = std::max(a[x], b[x]);
    }
    levels_.push_back(std::move(level));
  }
}

}  // namespace loopgrid
