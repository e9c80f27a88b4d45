#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace loopgrid {

/// Olson's lookup table: how likely a hit is in each cell, given reference points; and a pyramid of
/// maxima above it. A cell of level k holds the largest value of the 2^k x 2^k cells that begin
/// there. So one look-up gives an upper bound of the value for every shift in [0, 2^k)^2.
class LikelihoodTable {
 public:
  /// Covers [lower, upper] plus `margin` cells on each side with cells of `resolution` metres. A
  /// reference point gives 255 * exp(-d^2 / (2 sigma^2)) at distance d; cells take the largest.
  /// Points closer than 3 sigma to the table's edge are left out.
  LikelihoodTable(std::span<const Eigen::Vector2f> points, const Eigen::Vector2f& lower,
                  const Eigen::Vector2f& upper, int margin, float resolution, float sigma,
                  int levels);

  int width() const { return width_; }
  int height() const { return height_; }
  int levels() const { return static_cast<int>(levels_.size()); }
  float resolution() const { return resolution_; }
  float sigma() const { return sigma_; }

  /// Cell of a point; may lie outside the table.
  Eigen::Vector2i CellOf(const Eigen::Vector2f& p) const {
    const Eigen::Vector2f c = (p - origin_) * inverse_resolution_;
    return {Floor(c.x()), Floor(c.y())};
  }

  /// Likelihood of a hit in a cell, 0..255; 0 outside the table.
  int At(const Eigen::Vector2i& cell) const {
    const bool inside = cell.x() >= 0 && cell.y() >= 0 && cell.x() < width_ && cell.y() < height_;
    return inside ? levels_.front()[static_cast<std::size_t>(cell.y() * width_ + cell.x())] : 0;
  }

  const std::uint8_t* level(int k) const { return levels_[static_cast<std::size_t>(k)].get(); }

 private:
  std::size_t cell_count() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) + kOverrun;
  }
  static constexpr std::size_t kOverrun = 64;  // bytes a strip may reach beyond the last row
  static int Floor(float v) {                  // without SSE4.1 std::floor is a call
    const int i = static_cast<int>(v);
    return i - static_cast<int>(static_cast<float>(i) > v);
  }
  void Rasterize(std::span<const Eigen::Vector2f> points);
  void BuildPyramid(int levels);

  float resolution_;
  float sigma_;
  float inverse_resolution_;
  Eigen::Vector2f origin_;
  int width_ = 0;
  int height_ = 0;
  std::vector<std::unique_ptr<std::uint8_t[]>> levels_;
};

}  // namespace loopgrid
