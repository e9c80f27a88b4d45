#include "frontend/closing/closure_matcher.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "frontend/matching/match_covariance.h"
#include "frontend/matching/thinning.h"
#include "frontend/matching/visibility.h"

namespace loopgrid {
namespace {

constexpr double kReported = 0.8;        // of the least score: failures above it report their score
constexpr double kReportedSecond = 0.7;  // of the best score: second peaks above it are reported

int LevelsFor(double half_width, double resolution) {
  int levels = 2;
  while (levels < 7 && (1 << levels) * resolution < half_width) ++levels;
  return levels;
}

// The box that the points can reach from all poses in the window.
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

// The likelihood table of the part of the map that a search in `window` can use; nothing if that
// part is empty.
std::optional<LikelihoodTable> TableFor(const LocalMap& map,
                                        std::span<const Eigen::Vector2f> points, const SE2& center,
                                        const SearchWindow& window, double resolution,
                                        double sigma) {
  Eigen::Vector2f lower;
  Eigen::Vector2f upper;
  Reach(points, center, window, &lower, &upper);
  lower = lower.cwiseMax(map.lower());
  upper = upper.cwiseMin(map.upper());
  if ((upper - lower).minCoeff() <= 0.0F) return std::nullopt;
  std::vector<Eigen::Vector2f> surfaces;
  for (const Surfel& s : map.surfels()) {
    if ((s.position.array() >= lower.array()).all() &&
        (s.position.array() <= upper.array()).all()) {
      surfaces.push_back(s.position);
    }
  }
  const auto cell = static_cast<float>(resolution);
  const int levels = LevelsFor(std::max(window.x, window.y), resolution);
  const int margin = CorrelativeSearch::MarginFor(window, cell, levels) +
                     static_cast<int>(std::ceil(3.0 * sigma / resolution));
  return LikelihoodTable(surfaces, lower, upper, margin, cell, static_cast<float>(sigma), levels);
}

// Replaces a large window by a small one around the best place in it. False if no place reaches the
// least score.
bool SearchCoarsely(const LocalMap& map, std::span<const Eigen::Vector2f> surroundings,
                    const ClosureMatcherOptions& options, SE2* center, SearchWindow* window,
                    ClosureMatch* match) {
  const double cell = options.coarse_resolution;
  const std::vector<Eigen::Vector2f> points = LimitPoints(surroundings, options.coarse_points);
  const auto table = TableFor(map, points, *center, *window, cell, options.coarse_sigma);
  if (!table) return false;
  const double angle_step = AngleStepFor(points, cell);
  const CorrelativeSearch search(*table, points, *center, *window, angle_step);
  const SearchResult best = search.Best(kReported * options.min_score);
  match->score = best.score;
  if (best.score < options.min_score) return false;
  const int cells = static_cast<int>(std::ceil(options.peak_distance / cell));
  const int steps = static_cast<int>(std::ceil(options.peak_angle / angle_step));
  match->second_score =
      search.BestAwayFrom(best.offset, cells, steps, kReportedSecond * best.score).score;
  *center = best.T_map_robot;
  *window = {1.5 * cell, 1.5 * cell, 1.5 * angle_step};
  return true;
}

}  // namespace

ClosureMatch MatchClosure(const LocalMap& map, const PointScan& scan,
                          std::span<const Eigen::Vector2f> surroundings, const SE2& predicted,
                          const SearchWindow& window, const ClosureMatcherOptions& options) {
  ClosureMatch match;
  if (map.empty() || surroundings.empty()) return match;
  SE2 center = predicted;
  SearchWindow rest{std::min(window.x, options.widest), std::min(window.y, options.widest),
                    std::min(window.rotation, 3.14)};
  if (std::max(rest.x, rest.y) >= options.coarse_from &&
      !SearchCoarsely(map, surroundings, options, &center, &rest, &match)) {
    return match;
  }
  const double cell = options.fine_resolution;
  const std::vector<Eigen::Vector2f> points = ThinPoints(scan.hits, static_cast<float>(cell));
  const auto table = TableFor(map, points, center, rest, cell, options.fine_sigma);
  if (!table) return match;
  const CorrelativeSearch search(*table, points, center, rest, AngleStepFor(points, cell));
  const SearchResult best = search.Best(kReported * options.min_score);
  match.score = best.score;
  if (best.score < options.min_score) return match;
  const RefinedMatch refined = RefineMatch(
      map, scan, best.T_map_robot, {best.T_map_robot, Eigen::Matrix3d::Zero()}, options.refiner);
  match.T_map_robot = refined.T_map_robot;
  match.inlier_share = refined.inlier_share;
  match.found = refined.inlier_share >= options.min_inlier_share;
  if (!match.found) return match;
  match.covariance = MatchCovariance(*table, points, refined, options.covariance);
  match.denied_share =
      CompareVisibility(map, scan, refined.T_map_robot, options.visibility).denied_share();
  return match;
}

}  // namespace loopgrid
