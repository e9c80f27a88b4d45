#include "frontend/matching/point_scan.h"

#include <algorithm>
#include <cmath>

namespace loopgrid {
namespace {

// The unit normal of a line through the surface around hits[i]; zero if the points do not form a
// line.
Eigen::Vector2f NormalAt(const std::vector<Eigen::Vector2f>& hits, const std::vector<int>& beams,
                         int i, const NormalOptions& options) {
  const auto max_gap = static_cast<float>(options.max_gap);
  const auto max_reach = static_cast<float>(options.max_reach);
  const int count = static_cast<int>(hits.size());
  const auto at = [&](int k) -> const Eigen::Vector2f& {
    return hits[static_cast<std::size_t>(k)];
  };
  const auto beam = [&](int k) { return beams[static_cast<std::size_t>(k)]; };
  // Hits of grazing beams are far apart on the wall, so the nearest neighbour on each side is
  // always used.
  const auto joined = [&](int a, int b) {
    return beam(b) - beam(a) <= 2 && (at(a) - at(b)).norm() < max_gap;
  };
  int first = i;
  while (first > 0 && i - first < options.neighbours && joined(first - 1, first) &&
         (first == i || (at(first - 1) - at(i)).norm() < max_reach)) {
    --first;
  }
  int last = i;
  while (last + 1 < count && last - i < options.neighbours && joined(last, last + 1) &&
         (last == i || (at(last + 1) - at(i)).norm() < max_reach)) {
    ++last;
  }
  if (last - first < 2) return Eigen::Vector2f::Zero();

  Eigen::Vector2f mean = Eigen::Vector2f::Zero();
  for (int k = first; k <= last; ++k) mean += at(k);
  mean /= static_cast<float>(last - first + 1);
  float xx = 0.0F;
  float xy = 0.0F;
  float yy = 0.0F;
  for (int k = first; k <= last; ++k) {
    const Eigen::Vector2f d = at(k) - mean;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
  }
  const float scale = 1.0F / static_cast<float>(last - first + 1);
  const float half_trace = 0.5F * (xx + yy) * scale;
  const float root = std::sqrt(0.25F * (xx - yy) * (xx - yy) + xy * xy) * scale;
  const float along = std::sqrt(half_trace + root);
  const float across = std::sqrt(std::max(half_trace - root, 0.0F));
  if (along < 1e-4F || across > static_cast<float>(options.max_thickness) ||
      across > static_cast<float>(options.max_flatness) * along) {
    return Eigen::Vector2f::Zero();
  }
  const float direction = 0.5F * std::atan2(2.0F * xy, xx - yy);
  return {-std::sin(direction), std::cos(direction)};
}

}  // namespace

PointScan MakePointScan(const LaserScan& scan, double min_range, double max_range,
                        const NormalOptions& options) {
  PointScan result;
  result.T_robot_laser = scan.T_robot_laser;
  std::vector<int> beams;
  const std::size_t count = scan.ranges.size();
  result.hits.reserve(count);
  beams.reserve(count);
  const Eigen::Vector2f laser = scan.T_robot_laser.translation().cast<float>();
  for (std::size_t i = 0; i < count; ++i) {
    const double range = static_cast<double>(scan.ranges[i]);
    if (!(range >= min_range)) continue;
    const double angle =
        scan.T_robot_laser.theta() + scan.first_angle + scan.angle_step * static_cast<double>(i);
    const Eigen::Vector2f direction(static_cast<float>(std::cos(angle)),
                                    static_cast<float>(std::sin(angle)));
    if (range >= max_range) {
      result.no_returns.push_back(direction);
    } else {
      result.hits.emplace_back(laser + scan.ranges[i] * direction);
      beams.push_back(static_cast<int>(i));
    }
  }
  result.normals.reserve(result.hits.size());
  for (std::size_t i = 0; i < result.hits.size(); ++i) {
    Eigen::Vector2f normal = NormalAt(result.hits, beams, static_cast<int>(i), options);
    if (normal.dot(laser - result.hits[i]) < 0.0F) normal = -normal;
    result.normals.push_back(normal);
  }
  return result;
}

}  // namespace loopgrid
