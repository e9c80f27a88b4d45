#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "backend/graph/pose_graph.h"
#include "frontend/closing/closure.h"
#include "frontend/log/observation/observation.h"
#include "frontend/matching/point_scan.h"
#include "frontend/slam/slam_options.h"
#include "frontend/tracking/scan_trail.h"

namespace loopgrid {

/// The result for one scan.
struct TrackedScan {
  int scan = 0;     ///< its index, from 0
  SE2 T_map_robot;  ///< current best pose
  /// Covariance of the pose in the map, relative to the first node: the marginal covariance of the
  /// node that the pose refers to, composed with the covariance of the path from there (odometry,
  /// fused with the match if there is one). Robot frame, order (x, y, theta), metres and radians.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  bool matched = false;    ///< false: the match failed, the pose comes from odometry alone
  bool localized = true;   ///< false: the place of a new session in the old map is not known yet
  int node = -1;           ///< index of the node this scan became, -1 if none
  bool optimized = false;  ///< poses of older scans have moved
  std::vector<ClosureId> closures;  ///< those of closures() that are new or have changed
};

/// Seconds spent in each stage.
struct SlamTimes {
  double tracking = 0.0;
  double closing = 0.0;
  double optimizing = 0.0;
  double finishing = 0.0;
};

struct SlamStatistics {
  std::int64_t scans = 0;
  std::int64_t failed_matches = 0;  ///< scans that odometry alone placed
  std::int64_t unusable_scans = 0;  ///< scans with too few returns to match
  std::int64_t known_scans = 0;     ///< scans in known space: no nodes, no part of the map
  double error_before = 0.0;        ///< F of the final constraints at the odometry poses
  double error_after = 0.0;         ///< F of the final constraints at the final poses
  SlamTimes times;
};

/// Graph-based SLAM in one object: feed it odometry and scans, ask it for poses, graph and
/// uncertainty. Deterministic; no global state; one thread may use an object at a time.
class Slam {
 public:
  /// Throws Error (kUsage) if the options are not valid.
  explicit Slam(const SlamOptions& options = {});
  ~Slam();
  Slam(Slam&&) noexcept;
  Slam& operator=(Slam&&) noexcept;

  /// Takes the next scan of the log, in order of acquisition. A range of infinity is a beam without
  /// return; NaN and negative ranges are ignored. Throws Error (kInput) if the odometry
  /// is not finite; the scan is then not taken.
  TrackedScan AddScan(const Observation& observation);

  /// Ends the run: links neighbours whose scans overlap and optimises to convergence. Call once,
  /// after the last scan.
  void Finish();

  /// Nodes and constraints. Poses are T_map_robot.
  const PoseGraph<SE2>& graph() const;

  /// Index of the scan that each node holds.
  const std::vector<int>& node_scans() const;

  int scan_count() const;
  double scan_timestamp(int scan) const;
  SE2 scan_odometry(int scan) const;  ///< T_odom_robot as in the log

  /// Best T_map_robot of every scan so far.
  std::vector<SE2> ScanPoses() const;

  /// The returns of a scan, in the robot frame, metres; and the directions without a return.
  std::span<const Eigen::Vector2f> scan_hits(int scan) const;
  std::span<const Eigen::Vector2f> scan_no_returns(int scan) const;  ///< unit vectors, robot frame
  SE2 scan_laser(int scan) const;                                    ///< T_robot_laser

  ScanPlace scan_place(int scan) const;

  /// The scan's points, which other threads may keep; null if it adds nothing to the map.
  std::shared_ptr<const PointScan> scan_points(int scan) const;

  /// Every closure tried so far, in order.
  const std::vector<Closure>& closures() const;

  /// Covariance of every node relative to the last node, as of the last optimisation: the diagonal
  /// blocks of the inverse of the reduced Hessian, in each node's own frame, order (x, y, theta).
  /// That of the last node is zero.
  std::vector<Eigen::Matrix3d> NodeCovariances() const;

  SlamStatistics statistics() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace loopgrid
