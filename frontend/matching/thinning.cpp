#include "frontend/matching/thinning.h"

#include <algorithm>

namespace loopgrid {
std::vector<Eigen::Vector2f> ThinPoints(std::span<const Eigen::Vector2f> points, float spacing) {
  std::vector<Eigen::Vector2f> kept;
  kept.reserve(points.size());
  for (const Eigen::Vector2f& p : points) {
    if (kept.empty() || (p - kept.back()).squaredNorm() >= spacing * spacing) kept.push_back(p);
  }
  return kept;
}

std::vector<Eigen::Vector2f> LimitPoints(std::span<const Eigen::Vector2f> points,
                                         std::size_t count) {
  if (points.size() <= count) return {points.begin(), points.end()};
  std::vector<Eigen::Vector2f> kept;
  kept.reserve(count);
  for (std::size_t i = 0; i < count; ++i) kept.push_back(points[i * points.size() / count]);
  return kept;
}

double AngleStepFor(std::span<const Eigen::Vector2f> points, double resolution) {
  if (points.empty()) return 0.02;
  std::vector<float> ranges;
  ranges.reserve(points.size());
  for (const Eigen::Vector2f& p : points) ranges.push_back(p.norm());
  const auto most = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() * 8 / 10);
  std::nth_element(ranges.begin(), most, ranges.end());
  return std::clamp(resolution / std::max(static_cast<double>(*most), 0.1), 0.004, 0.02);
}

}  // namespace loopgrid
