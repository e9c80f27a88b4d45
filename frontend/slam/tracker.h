#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "frontend/matching/correlative_matcher.h"
#include "frontend/matching/local_map.h"
#include "frontend/matching/match_refiner.h"
#include "frontend/slam/odometry_noise.h"

namespace loopgrid {

struct TrackerOptions {
  OdometryNoise odometry;
  RefinerOptions refiner;
  double table_resolution = 0.05;  ///< metres
  double table_sigma = 0.07;       ///< metres
  double map_radius = 30.0;        ///< surfaces farther from the robot are left out, metres
  double min_score = 0.35;         ///< of the correlative search, 0..1
  double min_inlier_share = 0.4;   ///< of the refined match, 0..1
  int min_points = 20;             ///< scans with fewer hits are not matched
};

/// Where a scan is in the local map.
struct TrackedPose {
  SE2 T_map_robot;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the match; zero if it failed
  bool matched = false;
  double score = 0.0;  ///< of the correlative search, 0..1
};

/// Follows the robot from scan to scan: correlative search around the odometry's prediction in a map
/// of recent nodes, then continuous refinement.
class Tracker {
 public:
  explicit Tracker(const TrackerOptions& options = {}) : options_(options) {}

  /// The surfaces to match against, and where the robot is in them.
  void SetMap(std::span<const PlacedScan> scans, const SE2& T_map_robot);

  /// Finds `scan` after the robot moved by `motion` (odometry) since the last scan.
  TrackedPose Track(const PointScan& scan, const SE2& motion);

  const SE2& pose() const { return T_map_robot_; }

 private:
  TrackerOptions options_;
  SE2 T_map_robot_;
  LocalMap map_;
  std::unique_ptr<LikelihoodTable> table_;
};

/// Thins points to about one a square of `spacing` metres, keeping order; a dense near wall then
/// weighs no more than a far one.
std::vector<Eigen::Vector2f> ThinPoints(std::span<const Eigen::Vector2f> points, float spacing);

/// The angular step that moves most of `points` by no more than `resolution` metres, radians.
double AngleStepFor(std::span<const Eigen::Vector2f> points, double resolution);

}  // namespace loopgrid
