#include "frontend/tracking/tracker.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "frontend/matching/match_covariance.h"
#include "frontend/matching/thinning.h"
#include "frontend/tracking/odometry_noise.h"

namespace loopgrid {
namespace {

constexpr int kLevels = 4;  // of the likelihood table's pyramid

std::vector<Eigen::Vector2f> Positions(const LocalMap& map) {
  std::vector<Eigen::Vector2f> positions;
  positions.reserve(map.surfels().size());
  for (const Surfel& s : map.surfels()) positions.push_back(s.position);
  return positions;
}

}  // namespace

void Tracker::SetMap(std::span<const PlacedScan> scans, const SE2& T_map_robot) {
  T_map_robot_ = T_map_robot;
  map_ = LocalMap(scans, T_map_robot.translation(), options_.map_radius);
  table_.reset();
  if (map_.empty()) return;
  const SearchWindow widest{options_.lost_reach, options_.lost_reach, options_.widest_rotation};
  const auto resolution = static_cast<float>(options_.table_resolution);
  const auto sigma = static_cast<float>(options_.table_sigma);
  const int margin = CorrelativeSearch::MarginFor(widest, resolution, kLevels) +
                     static_cast<int>(std::ceil(3.0F * sigma / resolution));
  table_ = std::make_unique<LikelihoodTable>(Positions(map_), map_.lower(), map_.upper(), margin,
                                             resolution, sigma, kLevels);
}

TrackedPose Tracker::Track(const PointScan& scan, const SE2& motion) {
  const SE2 predicted = T_map_robot_ * motion;
  TrackedPose result;
  result.unusable = static_cast<int>(scan.size()) < options_.min_points;
  if (!result.unusable && table_ != nullptr) {
    result = Match(scan, predicted, motion);
    if (!result.matched) {
      const TrackedPose found = MatchWithoutOdometry(scan, predicted);
      if (found.matched) result = found;
    }
  }
  if (!result.matched) result.T_map_robot = predicted;
  T_map_robot_ = result.T_map_robot;
  return result;
}

TrackedPose Tracker::Match(const PointScan& scan, const SE2& predicted, const SE2& motion) const {
  const Eigen::Matrix3d covariance = OdometryCovariance(motion, options_.odometry);
  const double sigma_translation = std::sqrt(covariance(0, 0));
  const double sigma_rotation = std::sqrt(covariance(2, 2));
  const double reach = std::min(options_.window_sigmas * sigma_translation + options_.window_margin,
                                options_.lost_reach);
  const double turn =
      std::min(options_.window_sigmas * sigma_rotation + options_.window_angle_margin,
               options_.widest_rotation);
  const SearchWindow window{reach, reach, turn};
  const std::vector<Eigen::Vector2f> points =
      ThinPoints(scan.hits, static_cast<float>(options_.table_resolution));
  const CorrelativeSearch search(*table_, points, predicted, window,
                                 AngleStepFor(points, options_.table_resolution),
                                 {sigma_translation, sigma_rotation, options_.prior_weight});
  const SearchResult found = search.Best(0.0);
  if (!found.found || found.score < options_.min_score) {
    TrackedPose failed;
    failed.score = found.score;
    return failed;
  }
  return Refine(scan, points, found, {predicted, covariance.inverse()}, options_.min_inlier_share);
}

TrackedPose Tracker::MatchWithoutOdometry(const PointScan& scan, const SE2& predicted) const {
  const std::vector<Eigen::Vector2f> points =
      ThinPoints(scan.hits, static_cast<float>(options_.table_resolution));
  const double angle_step = AngleStepFor(points, options_.table_resolution);
  const CorrelativeSearch search(
      *table_, points, predicted,
      {options_.lost_reach, options_.lost_reach, std::numbers::pi - angle_step}, angle_step);
  const SearchResult found = search.Best(options_.lost_min_score);
  if (!found.found) return {};
  const int apart =
      static_cast<int>(std::ceil(options_.lost_peak_distance / options_.table_resolution));
  const int turned = static_cast<int>(std::ceil(options_.lost_peak_angle / angle_step));
  const double limit = options_.lost_max_second * found.score;
  if (search.BestAwayFrom(found.offset, apart, turned, limit).found) return {};
  return Refine(scan, points, found, {found.T_map_robot, Eigen::Matrix3d::Zero()},
                options_.lost_min_inlier_share);
}

TrackedPose Tracker::Refine(const PointScan& scan, std::span<const Eigen::Vector2f> points,
                            const SearchResult& found, const PosePrior& prior,
                            double min_inlier_share) const {
  TrackedPose result;
  result.score = found.score;
  const RefinedMatch match = RefineMatch(map_, scan, found.T_map_robot, prior, options_.refiner);
  result.inlier_share = match.inlier_share;
  if (match.inlier_share < min_inlier_share) return result;
  result.T_map_robot = match.T_map_robot;
  result.covariance = MatchCovariance(*table_, points, match, options_.covariance);
  result.matched = true;
  return result;
}

}  // namespace loopgrid
