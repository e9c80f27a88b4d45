#pragma once

#include <Eigen/Core>
#include <optional>

#include "backend/geometry/se2.h"
#include "frontend/tracking/tracking_options.h"

namespace loopgrid {

/// Where the robot is: relative to a node of the graph, so that it moves with the node, and how
/// certain that is. Covariances are in the robot frame, order (x, y, theta), metres and radians.
class RobotPose {
 public:
  /// `unmatched_factor` multiplies the odometry's covariance where a scan was not matched.
  RobotPose(const OdometryNoise& odometry, double unmatched_factor)
      : odometry_(odometry), unmatched_factor_(unmatched_factor) {}

  /// The robot is at a new node.
  void StartAt(int node);

  /// The robot goes on from another node, an old one that is near. It is as certain as before.
  void ReferTo(int node, const SE2& T_node_robot);

  /// The robot has moved: by `motion` according to the odometry, to `T_reference_robot` according
  /// to tracking. `match` is the covariance of the match, nothing if there was none.
  void Move(const SE2& motion, const SE2& T_reference_robot,
            const std::optional<Eigen::Matrix3d>& match);

  /// The last scan was matched again, with covariance `match`, and gave another pose. The robot is
  /// as certain as before: matching one scan twice does not make it more so.
  void Correct(const SE2& T_reference_robot, const Eigen::Matrix3d& match);

  int reference() const { return reference_; }
  const SE2& T_reference_robot() const { return T_reference_robot_; }

  /// Metres travelled since the last StartAt(), by odometry.
  double travel() const { return travel_; }

  /// Of T_reference_robot() as a constraint. From the node that the robot started at, odometry
  /// fused with the match. From an old node, to which the robot came from elsewhere, the match
  /// alone, which may leave a direction open.
  const Eigen::Matrix3d& edge_covariance() const { return edge_covariance_; }

  /// Of T_reference_robot() by all that is known: what was known when the robot was first referred
  /// to the node, moved on by odometry, fused with the match.
  const Eigen::Matrix3d& covariance() const { return covariance_; }

 private:
  OdometryNoise odometry_;
  double unmatched_factor_;
  int reference_ = 0;
  SE2 T_reference_robot_;
  bool from_elsewhere_ = false;  // the robot did not start at the reference
  SE2 motion_;                   // since it was first referred to the node, by odometry
  double travel_ = 0.0;
  Eigen::Matrix3d edge_covariance_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d covariance_at_reference_ = Eigen::Matrix3d::Zero();  // before `motion_`
};

}  // namespace loopgrid
