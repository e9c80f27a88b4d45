#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "frontend/matching/correlative_matcher.h"
#include "frontend/matching/local_map.h"
#include "frontend/matching/match_refiner.h"
#include "frontend/tracking/odometry_noise.h"

namespace loopgrid {

struct TrackerOptions {
  OdometryNoise odometry;
  RefinerOptions refiner;
  double table_resolution = 0.05;  ///< of the likelihood table, metres
  double table_sigma = 0.07;       ///< reach of a reference point in it, metres
  double map_radius = 30.0;        ///< surfaces farther from the robot are left out, metres
  double min_score = 0.35;         ///< of the correlative search, 0..1
  double min_inlier_share = 0.25;  ///< of the refined match, 0..1
  int min_points = 20;             ///< scans with fewer hits are not matched
  double lost_reach = 1.0;         ///< half width searched when the odometry was no help, metres
  double lost_min_score = 0.5;     ///< what the search must reach then, 0..1 ...
  double lost_min_inlier_share = 0.65;  ///< ... and the refined one
  double lost_max_second = 0.8;         ///< ... and no other place may reach this share of it
};

/// Where a scan is in the local map.
struct TrackedPose {
  SE2 T_map_robot;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the match, robot frame
  bool matched = false;
  bool unusable = false;      ///< too few hits to match
  double score = 0.0;         ///< of the correlative search, 0..1
  double inlier_share = 0.0;  ///< of the refined match, 0..1
};

/// Follows the robot from scan to scan: correlative search around the odometry's prediction in a
/// map of recent nodes, then continuous refinement.
class Tracker {
 public:
  explicit Tracker(const TrackerOptions& options = {}) : options_(options) {}

  /// The surfaces to match against, and where the robot is in them.
  void SetMap(std::span<const PlacedScan> scans, const SE2& T_map_robot);

  /// Finds `scan` after the robot moved by `motion` (odometry) since the last scan.
  TrackedPose Track(const PointScan& scan, const SE2& motion);

  const SE2& pose() const { return T_map_robot_; }

 private:
  /// What the search in a window around the prediction yields.
  TrackedPose Match(const PointScan& scan, const SE2& predicted, const SE2& motion) const;
  /// Odometry can be plainly wrong (a slip, a gap in the log): looks all around.
  TrackedPose MatchWithoutOdometry(const PointScan& scan, const SE2& predicted) const;
  TrackedPose Refine(const PointScan& scan, std::span<const Eigen::Vector2f> points,
                     const SearchResult& found, const PosePrior& prior,
                     double min_inlier_share) const;

  TrackerOptions options_;
  SE2 T_map_robot_;
  LocalMap map_;
  std::unique_ptr<LikelihoodTable> table_;
};

}  // namespace loopgrid
