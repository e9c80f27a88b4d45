#include "frontend/slam/closure_matcher.h"

#include <algorithm>
#include <cmath>

#include "frontend/matching/thinning.h"

namespace loopgrid {
namespace {

int LevelsFor(double half_width, double resolution) {
  int levels = 2;
  while (levels < 7 && (1 << levels) * resolution < half_width) ++levels;
  return levels;
}

// The part of the plane that the points can reach from anywhere in the window.
void Reach(std::span<const Eigen::Vector2f> points, const SE2& center, const SearchWindow& window,
           Eigen::Vector2f* lower, Eigen::Vector2f* upper) {
  Eigen::Vector2d low = center.translation();
  Eigen::Vector2d high = low;
  for (const Eigen::Vector2f& p : points) {
    const Eigen::Vector2d q = center * p.cast<double>();
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  double farthest = 0.0;
  for (const Eigen::Vector2f& p : points) {
    farthest = std::max(farthest, static_cast<double>(p.norm()));
  }
  const double swing = farthest * std::min(window.rotation, 2.0);
  const Eigen::Vector2d extra(window.x + swing, window.y + swing);
  *lower = (low - extra).cast<float>();
  *upper = (high + extra).cast<float>();
}

}  // namespace

ClosureMatch MatchClosure(const LocalMap& map, const PointScan& scan,
                          std::span<const Eigen::Vector2f> surroundings, const SE2& predicted,
                          const SearchWindow& window, const ClosureMatcherOptions& options) {
  ClosureMatch match;
  if (map.empty() || surroundings.empty()) return match;
  const SearchWindow clipped{std::min(window.x, options.widest), std::min(window.y, options.widest),
                             std::min(window.rotation, 3.14)};
  const double half_width = std::max(clipped.x, clipped.y);
  const bool coarse = half_width >= options.coarse_from;
  const double resolution = coarse ? options.coarse_resolution : options.fine_resolution;
  const auto cell = static_cast<float>(resolution);
  const float sigma = coarse ? cell : 1.4F * cell;

  const std::vector<Eigen::Vector2f> points = ThinPoints(surroundings, cell);
  Eigen::Vector2f lower;
  Eigen::Vector2f upper;
  Reach(points, predicted, clipped, &lower, &upper);
  lower = lower.cwiseMax(map.lower());
  upper = upper.cwiseMin(map.upper());
  if ((upper - lower).minCoeff() <= 0.0F) return match;
  std::vector<Eigen::Vector2f> surfaces;
  for (const Surfel& s : map.surfels()) {
    if ((s.position.array() >= lower.array()).all() &&
        (s.position.array() <= upper.array()).all()) {
      surfaces.push_back(s.position);
    }
  }
  const int levels = LevelsFor(half_width, resolution);
  const int margin = CorrelativeSearch::MarginFor(clipped, cell, levels) +
                     static_cast<int>(std::ceil(3.0F * sigma / cell));
  const LikelihoodTable table(surfaces, lower, upper, margin, cell, sigma, levels);
  const double angle_step = AngleStepFor(points, resolution);
  const CorrelativeSearch search(table, points, predicted, clipped, angle_step);
  const SearchResult best = search.Best(0.7 * options.min_score);
  if (!best.found) return match;
  match.score = best.score;
  if (best.score < options.min_score) return match;
  if (coarse) {
    const SearchResult second = search.BestAwayFrom(
        best.offset, static_cast<int>(std::ceil(options.peak_distance / resolution)),
        static_cast<int>(std::ceil(options.peak_angle / angle_step)), 0.7 * best.score);
    match.second_score = second.score;
  }
  const RefinedMatch refined = RefineMatch(
      map, scan, best.T_map_robot, {best.T_map_robot, Eigen::Matrix3d::Zero()}, options.refiner);
  match.T_map_robot = refined.T_map_robot;
  match.information = refined.information;
  match.inlier_share = refined.inlier_share;
  match.found = refined.inlier_share >= options.min_inlier_share;
  return match;
}

}  // namespace loopgrid
