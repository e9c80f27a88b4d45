#include "backend/geometry/se2.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>
#include <random>

namespace loopgrid {
namespace {

constexpr double kPi = std::numbers::pi;

SE2 RandomPose(std::mt19937* random) {
  std::uniform_real_distribution<double> place(-100.0, 100.0);
  std::uniform_real_distribution<double> angle(-kPi, kPi);
  return SE2(place(*random), place(*random), angle(*random));
}

void ExpectSamePose(const SE2& a, const SE2& b, double tolerance) {
  EXPECT_NEAR(a.x(), b.x(), tolerance);
  EXPECT_NEAR(a.y(), b.y(), tolerance);
  EXPECT_NEAR(NormalizeAngle(a.theta() - b.theta()), 0.0, tolerance);
}

Eigen::Matrix3d Homogeneous(const SE2& pose) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m.topLeftCorner<2, 2>() = pose.rotation();
  m.topRightCorner<2, 1>() = pose.translation();
  return m;
}

TEST(SE2, AgreesWithHomogeneousMatrices) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const SE2 a = RandomPose(&random);
    const SE2 b = RandomPose(&random);
    EXPECT_TRUE(Homogeneous(a * b).isApprox(Homogeneous(a) * Homogeneous(b), 1e-12));
    EXPECT_TRUE(Homogeneous(a.Inverse()).isApprox(Homogeneous(a).inverse(), 1e-9));
    const Eigen::Vector2d p(3.0, -4.0);
    EXPECT_TRUE((a * p).isApprox((Homogeneous(a) * p.homogeneous()).head<2>(), 1e-12));
  }
}

TEST(SE2, BoxminusUndoesBoxplus) {
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) {
    const SE2 a = RandomPose(&random);
    const Eigen::Vector3d d = RandomPose(&random).coordinates();
    EXPECT_TRUE(a.Boxplus(d).Boxminus(a).isApprox(d, 1e-10));
  }
}

TEST(SE2, LogUndoesExpFromZeroToNearlyPi) {
  for (double angle : {0.0, 1e-9, -1e-9, 1e-4, 9.9e-5, 0.5, -2.0, kPi - 1e-9, -kPi}) {
    const Eigen::Vector3d twist(1.5, -0.3, angle);
    EXPECT_TRUE(SE2::Exp(twist).Log().isApprox(twist, 1e-9)) << angle;
  }
}

TEST(SE2, ExpOfConstantTwistIsItsHalfTwice) {
  const Eigen::Vector3d twist(0.8, -0.2, 1.1);
  const SE2 half = SE2::Exp(0.5 * twist);
  ExpectSamePose(half * half, SE2::Exp(twist), 1e-12);
}

TEST(SE2, AdjointMovesSmallMotionsBetweenFrames) {
  std::mt19937 random(3);
  for (int i = 0; i < 50; ++i) {
    const SE2 T = RandomPose(&random);
    const Eigen::Vector3d d = 1e-9 * RandomPose(&random).coordinates();
    const SE2 moved = T * SE2(d) * T.Inverse();
    EXPECT_TRUE((T.Adjoint() * d).isApprox(moved.coordinates(), 1e-4)) << "seed 3, case " << i;
  }
}

TEST(SE2, StaysExactFarAway) {
  const SE2 far(1e7, -1e7, 3.0);
  ExpectSamePose(far.Inverse() * far, SE2(), 1e-8);
}

}  // namespace
}  // namespace loopgrid
