#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace loopgrid {

/// Olson's lookup table: how likely a hit is in each cell, given reference points; with a pyramid
/// of maxima above it. Level k holds in each cell the largest value of the 2^k x 2^k cells that
/// begin there, so one look-up bounds the value for every shift in [0, 2^k)^2.
class LikelihoodTable {
 public:
  /// Covers [lower, upper] plus `margin` cells on each side with cells of `resolution` metres. A
  /// reference point gives 255 * exp(-d^2 / (2 sigma^2)) at distance d; cells take the largest.
  LikelihoodTable(std::span<const Eigen::Vector2f> points, const Eigen::Vector2f& lower,
                  const Eigen::Vector2f& upper, int margin, float resolution, float sigma,
                  int levels);

  int width() const { return width_; }
  int height() const { return height_; }
  int levels() const { return static_cast<int>(levels_.size()); }
  float resolution() const { return resolution_; }

  /// Cell of a point; may lie outside the table.
  Eigen::Vector2i CellOf(const Eigen::Vector2f& p) const {
    const Eigen::Vector2f c = (p - origin_) * inverse_resolution_;
    return {static_cast<int>(std::floor(c.x())), static_cast<int>(std::floor(c.y()))};
  }

  const std::uint8_t* level(int k) const { return levels_[static_cast<std::size_t>(k)].data(); }

 private:
  void Rasterize(std::span<const Eigen::Vector2f> points, float sigma);
  void BuildPyramid(int levels);

  float resolution_;
  float inverse_resolution_;
  Eigen::Vector2f origin_;
  int width_ = 0;
  int height_ = 0;
  std::vector<std::vector<std::uint8_t>> levels_;
};

}  // namespace loopgrid
