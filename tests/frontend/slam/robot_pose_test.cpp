#include "frontend/slam/robot_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <optional>

#include "frontend/tracking/odometry_noise.h"
#include "frontend/tracking/pose_covariance.h"

namespace loopgrid {
namespace {

constexpr double kTestedFactor = 4.0;

// A match that leaves x open: 20 m stand for "unknown".
Eigen::Matrix3d CorridorMatch() { return Eigen::Vector3d(400.0, 1e-4, 1e-5).asDiagonal(); }

Eigen::Matrix3d GoodMatch() { return Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal(); }

RobotPose PoseToTest() { return {OdometryNoise(), kTestedFactor}; }

TEST(RobotPose, IsCertainAtANewNode) {
  RobotPose robot = PoseToTest();
  robot.Move(SE2(0.3, 0.0, 0.1), SE2(0.3, 0.0, 0.1), std::nullopt);
  robot.StartAt(7);
  EXPECT_EQ(robot.reference(), 7);
  EXPECT_TRUE(robot.T_reference_robot().coordinates().isZero(0.0));
  EXPECT_TRUE(robot.covariance().isZero(0.0));
  EXPECT_TRUE(robot.edge_covariance().isZero(0.0));
  EXPECT_EQ(robot.travel(), 0.0);
}

TEST(RobotPose, FusesTheOdometrySinceTheNodeWithTheLatestMatch) {
  RobotPose robot = PoseToTest();
  robot.StartAt(0);
  const SE2 step(0.2, 0.0, 0.05);
  robot.Move(step, step, GoodMatch());
  robot.Move(step, step * step, CorridorMatch());
  const Eigen::Matrix3d odometry = OdometryCovariance(step * step, OdometryNoise());
  const Eigen::Matrix3d expected = (odometry.inverse() + CorridorMatch().inverse()).inverse();
  EXPECT_LT((robot.covariance() - expected).norm(), 1e-12);
  EXPECT_EQ(robot.edge_covariance(), robot.covariance());
  EXPECT_DOUBLE_EQ(robot.travel(), 0.4);
}

TEST(RobotPose, WithoutAMatchGoesByOdometryThatIsTrustedLess) {
  RobotPose robot = PoseToTest();
  robot.StartAt(0);
  const SE2 step(0.2, 0.0, 0.05);
  robot.Move(step, step, std::nullopt);
  const Eigen::Matrix3d expected = kTestedFactor * OdometryCovariance(step, OdometryNoise());
  EXPECT_LT((robot.covariance() - expected).norm(), 1e-15);
  EXPECT_EQ(robot.edge_covariance(), robot.covariance());
}

TEST(RobotPose, AnOldNodeLeavesItAsCertainAsBefore) {
  RobotPose robot = PoseToTest();
  robot.StartAt(0);
  const SE2 step(0.5, 0.0, 0.0);
  robot.Move(step, step, GoodMatch());
  const Eigen::Matrix3d before = robot.covariance();
  robot.Correct(step * SE2(0.01, 0.0, 0.0), CorridorMatch());
  EXPECT_EQ(robot.covariance(), before);
  EXPECT_EQ(robot.edge_covariance(), CorridorMatch());
  robot.ReferTo(3, SE2(0.1, 0.2, 0.3));
  EXPECT_EQ(robot.reference(), 3);
  EXPECT_EQ(robot.covariance(), before);
  // The covariance of an edge from that node is that of the match alone.
  robot.Move(step, SE2(0.6, 0.2, 0.3), CorridorMatch());
  EXPECT_EQ(robot.edge_covariance(), CorridorMatch());
  const Eigen::Matrix3d moved =
      ComposeCovariances(before, step, OdometryCovariance(step, OdometryNoise()));
  EXPECT_LT((robot.covariance() - FuseCovariances(moved, CorridorMatch())).norm(), 1e-9);
}

TEST(RobotPose, GrowsLikeOdometryAlongACorridorAndStaysNarrowAcrossIt) {
  RobotPose robot = PoseToTest();
  robot.StartAt(0);
  const SE2 step(0.5, 0.0, 0.0);
  robot.Move(step, step, GoodMatch());
  double last = 0.0;
  for (int node = 1; node <= 100; ++node) {
    robot.ReferTo(node, SE2());
    robot.Move(step, step, CorridorMatch());
    EXPECT_GT(robot.covariance()(0, 0), last) << node;
    EXPECT_LT(robot.covariance()(1, 1), 1.01e-4) << node;
    last = robot.covariance()(0, 0);
  }
  const double sigma_a_step = 0.01 + 0.15 * 0.5;  // of the odometry's defaults
  EXPECT_LT(std::sqrt(last), 1.01 * std::sqrt(101.0) * sigma_a_step);
  // After one good match the pose is certain again.
  robot.Move(step, step, GoodMatch());
  EXPECT_LT(robot.covariance()(0, 0), 1.01e-4);
}

}  // namespace
}  // namespace loopgrid
