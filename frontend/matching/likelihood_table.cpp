#include "frontend/matching/likelihood_table.h"

#include <algorithm>
#include <cmath>

namespace loopgrid {
namespace {

constexpr int kStrip = 16;  // bytes that a processor compares at once

}  // namespace

LikelihoodTable::LikelihoodTable(std::span<const Eigen::Vector2f> points,
                                 const Eigen::Vector2f& lower, const Eigen::Vector2f& upper,
                                 int margin, float resolution, float sigma, int levels)
    : resolution_(resolution),
      sigma_(sigma),
      inverse_resolution_(1.0F / resolution),
      origin_(lower - Eigen::Vector2f::Constant(static_cast<float>(margin) * resolution)),
      width_(static_cast<int>((upper.x() - lower.x()) / resolution) + 1 + 2 * margin),
      height_(static_cast<int>((upper.y() - lower.y()) / resolution) + 1 + 2 * margin) {
  levels_.push_back(std::make_unique<std::uint8_t[]>(cell_count()));
  Rasterize(points);
  BuildPyramid(levels);
}

// Draws a kernel around the cell of each point. The kernel's rows are padded with zeros to whole
// strips, so that the inner loop computes a fixed number of byte maxima.
void LikelihoodTable::Rasterize(std::span<const Eigen::Vector2f> points) {
  const int reach = static_cast<int>(std::ceil(3.0F * sigma_ / resolution_));
  const int side = 2 * reach + 1;
  const int strips = (side + kStrip - 1) / kStrip;
  const int stride = strips * kStrip;
  std::vector<std::uint8_t> kernel(static_cast<std::size_t>(side * stride), 0);
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const float squared = static_cast<float>(x * x + y * y) * resolution_ * resolution_;
      kernel[static_cast<std::size_t>((y + reach) * stride + x + reach)] =
          static_cast<std::uint8_t>(
              std::lround(255.0F * std::exp(-0.5F * squared / (sigma_ * sigma_))));
    }
  }
  std::uint8_t* cells = levels_.front().get();
  for (const Eigen::Vector2f& p : points) {
    const Eigen::Vector2i c = CellOf(p);
    if (c.x() < reach || c.x() + reach >= width_) continue;
    if (c.y() < reach || c.y() + reach >= height_) continue;
    std::uint8_t* row = cells + static_cast<std::ptrdiff_t>(c.y() - reach) * width_ + c.x() - reach;
    for (const std::uint8_t* stamp = kernel.data(); stamp < kernel.data() + side * stride;
         stamp += stride, row += width_) {
      for (int x = 0; x < stride; x += kStrip) {
        for (int i = 0; i < kStrip; ++i) row[x + i] = std::max(row[x + i], stamp[x + i]);
      }
    }
  }
}

// Doubling: the maximum over 2^k cells is the larger of two maxima over 2^(k-1).
void LikelihoodTable::BuildPyramid(int levels) {
  const auto rows = std::make_unique_for_overwrite<std::uint8_t[]>(cell_count());
  for (int k = 1; k < levels; ++k) {
    const int shift = 1 << (k - 1);
    const std::uint8_t* below = levels_.back().get();
    for (int y = 0; y < height_; ++y) {
      const std::uint8_t* in = below + static_cast<std::ptrdiff_t>(y) * width_;
      std::uint8_t* out = rows.get() + static_cast<std::ptrdiff_t>(y) * width_;
      const int both = std::max(width_ - shift, 0);
      for (int x = 0; x < both; ++x) out[x] = std::max(in[x], in[x + shift]);
      for (int x = both; x < width_; ++x) out[x] = in[x];
    }
    auto level = std::make_unique_for_overwrite<std::uint8_t[]>(cell_count());
    for (int y = 0; y < height_; ++y) {
      const std::uint8_t* a = rows.get() + static_cast<std::ptrdiff_t>(y) * width_;
      const bool has_below = y + shift < height_;
      const std::uint8_t* b = has_below ? a + static_cast<std::ptrdiff_t>(shift) * width_ : a;
      std::uint8_t* out = level.get() + static_cast<std::ptrdiff_t>(y) * width_;
      for (int x = 0; x < width_; ++x) out[x] = std::max(a[x], b[x]);
    }
    levels_.push_back(std::move(level));
  }
}

}  // namespace loopgrid
