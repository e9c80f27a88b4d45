#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "frontend/matching/correlative_matcher.h"
#include "frontend/matching/local_map.h"
#include "frontend/matching/match_refiner.h"
#include "frontend/tracking/tracking_options.h"

namespace loopgrid {

/// Where a scan is in the local map.
struct TrackedPose {
  SE2 T_map_robot;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the match, robot frame
  bool matched = false;
  bool unusable = false;      ///< too few hits to match
  double score = 0.0;         ///< of the correlative search, 0..1
  double inlier_share = 0.0;  ///< of the refined match, 0..1
};

/// Tracks the robot from scan to scan: a correlative search around the odometry's prediction in a
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
  /// Searches in a window around the prediction.
  TrackedPose Match(const PointScan& scan, const SE2& predicted, const SE2& motion) const;
  /// Searches in all directions, because odometry can be very wrong after a slip or a gap in the
  /// log.
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
