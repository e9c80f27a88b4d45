#include "frontend/slam/tracker.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace loopgrid {
namespace {

constexpr int kLevels = 3;
constexpr double kWindowSigmas = 3.0;
constexpr double kWidestWindow = 1.0;    // metres
constexpr double kWidestRotation = 0.6;  // radians
constexpr double kPriorWeight = 0.02;

std::vector<Eigen::Vector2f> Positions(const LocalMap& map) {
  std::vector<Eigen::Vector2f> positions;
  positions.reserve(map.surfels().size());
  for (const Surfel& s : map.surfels()) positions.push_back(s.position);
  return positions;
}

}  // namespace

std::vector<Eigen::Vector2f> ThinPoints(std::span<const Eigen::Vector2f> points, float spacing) {
  std::vector<Eigen::Vector2f> kept;
  kept.reserve(points.size());
  for (const Eigen::Vector2f& p : points) {
    if (kept.empty() || (p - kept.back()).squaredNorm() >= spacing * spacing) kept.push_back(p);
  }
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

void Tracker::SetMap(std::span<const PlacedScan> scans, const SE2& T_map_robot) {
  T_map_robot_ = T_map_robot;
  map_ = LocalMap(scans, T_map_robot.translation(), options_.map_radius);
  table_.reset();
  if (map_.empty()) return;
  const SearchWindow widest{kWidestWindow, kWidestWindow, kWidestRotation};
  const auto resolution = static_cast<float>(options_.table_resolution);
  const auto sigma = static_cast<float>(options_.table_sigma);
  const int margin = CorrelativeSearch::MarginFor(widest, resolution, kLevels) +
                     static_cast<int>(std::ceil(3.0F * sigma / resolution));
  table_ = std::make_unique<LikelihoodTable>(Positions(map_), map_.lower(), map_.upper(), margin,
                                             resolution, sigma, kLevels);
}

TrackedPose Tracker::Track(const PointScan& scan, const SE2& motion) {
  TrackedPose result;
  const SE2 predicted = T_map_robot_ * motion;
  result.T_map_robot = T_map_robot_ = predicted;
  if (static_cast<int>(scan.size()) < options_.min_points || table_ == nullptr) return result;

  const Eigen::Matrix3d covariance = options_.odometry.Covariance(motion);
  const double sigma_translation = std::sqrt(covariance(0, 0));
  const double sigma_rotation = std::sqrt(covariance(2, 2));
  const double reach = std::min(kWindowSigmas * sigma_translation + 0.05, kWidestWindow);
  const SearchWindow window{reach, reach,
                            std::min(kWindowSigmas * sigma_rotation + 0.02, kWidestRotation)};
  const std::vector<Eigen::Vector2f> points =
      ThinPoints(scan.hits, static_cast<float>(options_.table_resolution));
  const CorrelativeSearch search(*table_, points, predicted, window,
                                 AngleStepFor(points, options_.table_resolution),
                                 {sigma_translation, sigma_rotation, kPriorWeight});
  const SearchResult found = search.Best(0.0);
  result.score = found.score;
  if (!found.found || found.score < options_.min_score) return result;

  const RefinedMatch match =
      RefineMatch(map_, scan, found.T_map_robot, {predicted, covariance.inverse()}, options_.refiner);
  if (match.inlier_share < options_.min_inlier_share) return result;
  result.T_map_robot = T_map_robot_ = match.T_map_robot;
  result.information = match.information;
  result.matched = true;
  return result;
}

}  // namespace loopgrid
