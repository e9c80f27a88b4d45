#pragma once

#include <Eigen/Core>
#include <optional>

#include "backend/geometry/se2.h"
#include "frontend/tracking/tracking_options.h"

namespace loopgrid {

/// The pose of the robot relative to a node of the graph, and its covariance. When the node moves,
/// the robot moves with it. Covariances are in the robot frame, order (x, y, theta), metres and
/// radians.
class RobotPose {
 public:
  /// `unmatched_factor` multiplies the odometry's covariance if a scan was not matched.
  RobotPose(const OdometryNoise& odometry, double unmatched_factor)
      : odometry_(odometry), unmatched_factor_(unmatched_factor) {}

  /// The robot is at a new node.
  void StartAt(int node);

  /// From now on the pose is relative to another node, an old one near the robot. Its covariance
  /// stays as it was.
  void ReferTo(int node, const SE2& T_node_robot);

  /// The robot has moved by `motion` (odometry), and tracking has found it at `T_reference_robot`.
  /// `match` is the covariance of the match, nothing if there was none.
  void Move(const SE2& motion, const SE2& T_reference_robot,
            const std::optional<Eigen::Matrix3d>& match);

  /// The last scan was matched again, with covariance `match`, and gave another pose. The pose does
  /// not become more certain, because it is the same scan.
  void Correct(const SE2& T_reference_robot, const Eigen::Matrix3d& match);

  int reference() const { return reference_; }
  const SE2& T_reference_robot() const { return T_reference_robot_; }

  /// Metres travelled since the last StartAt(), by odometry.
  double travel() const { return travel_; }

  /// Covariance of T_reference_robot() as a constraint. If the robot started at the node, it is
  /// odometry fused with the match. If the robot came to the node from elsewhere, it is that of the
  /// match alone, which may be unknown in a direction.
  const Eigen::Matrix3d& edge_covariance() const { return edge_covariance_; }

  /// Covariance of T_reference_robot() from everything known: the covariance at the time when the
  /// pose was first given relative to the node, propagated by odometry, fused with the match.
  const Eigen::Matrix3d& covariance() const { return covariance_; }

 private:
  OdometryNoise odometry_;
  double unmatched_factor_;
  int reference_ = 0;
  SE2 T_reference_robot_;
  bool from_elsewhere_ = false;  // the robot did not start at the reference
  SE2 motion_;                   // by odometry, since the pose was first relative to the node
  double travel_ = 0.0;
  Eigen::Matrix3d edge_covariance_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d covariance_at_reference_ = Eigen::Matrix3d::Zero();  // before `motion_`
};

}  // namespace loopgrid
