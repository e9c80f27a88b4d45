#include "frontend/slam/robot_pose.h"

#include "frontend/tracking/odometry_noise.h"
#include "frontend/tracking/pose_covariance.h"

namespace loopgrid {

void RobotPose::StartAt(int node) {
  reference_ = node;
  T_reference_robot_ = SE2();
  from_elsewhere_ = false;
  motion_ = SE2();
  travel_ = 0.0;
  edge_covariance_ = covariance_ = covariance_at_reference_ = Eigen::Matrix3d::Zero();
}

void RobotPose::ReferTo(int node, const SE2& T_node_robot) {
  reference_ = node;
  T_reference_robot_ = T_node_robot;
  from_elsewhere_ = true;
  motion_ = SE2();
  covariance_at_reference_ = covariance_;
}

void RobotPose::Move(const SE2& motion, const SE2& T_reference_robot,
                     const std::optional<Eigen::Matrix3d>& match) {
  motion_ = motion_ * motion;
  travel_ += motion.translation().norm();
  T_reference_robot_ = T_reference_robot;
  Eigen::Matrix3d odometry = OdometryCovariance(motion_, odometry_);
  if (!match) odometry *= unmatched_factor_;
  if (!from_elsewhere_) {
    edge_covariance_ = match ? FuseCovariances(odometry, *match) : odometry;
    covariance_ = edge_covariance_;
    return;
  }
  edge_covariance_ = match.value_or(odometry);
  covariance_ = ComposeCovariances(covariance_at_reference_, motion_, odometry);
  if (match) covariance_ = FuseCovariances(covariance_, *match);
}

void RobotPose::Correct(const SE2& T_reference_robot, const Eigen::Matrix3d& match) {
  T_reference_robot_ = T_reference_robot;
  edge_covariance_ = match;
}

}  // namespace loopgrid
