#include "frontend/tracking/pose_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace loopgrid {
namespace {

// A random positive definite matrix with standard deviations of about `sigma`.
Eigen::Matrix3d RandomPoseCovariance(double sigma, std::mt19937* random) {
  std::normal_distribution<double> normal;
  Eigen::Matrix3d A;
  for (double& entry : A.reshaped()) entry = sigma * normal(*random);
  return A * A.transpose() + 0.01 * sigma * sigma * Eigen::Matrix3d::Identity();
}

SE2 RandomStep(std::mt19937* random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return {8.0 * uniform(*random), 8.0 * uniform(*random), 3.0 * uniform(*random)};
}

// d (error of the end) / d (error of the start), by central differences.
Eigen::Matrix3d NumericJacobian(const SE2& step) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix3d J;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(k);
    const Eigen::Vector3d ahead = (SE2().Boxplus(d) * step).Boxminus(step);
    const Eigen::Vector3d behind = (SE2().Boxplus(-d) * step).Boxminus(step);
    J.col(k) = (ahead - behind) / (2.0 * kStep);
  }
  return J;
}

TEST(ComposeCovariances, IsTheFirstOrderPropagationOfTheErrors) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Eigen::Matrix3d first = RandomPoseCovariance(0.3, &random);
    const Eigen::Matrix3d second = RandomPoseCovariance(0.1, &random);
    const SE2 step = RandomStep(&random);
    const Eigen::Matrix3d J = NumericJacobian(step);
    const Eigen::Matrix3d expected = J * first * J.transpose() + second;
    const Eigen::Matrix3d composed = ComposeCovariances(first, step, second);
    EXPECT_LT((composed - expected).norm(), 1e-7 * expected.norm());
    EXPECT_EQ(composed, composed.transpose().eval());
  }
}

TEST(ComposeCovariances, IsTheSpreadOfManyRandomWays) {
  constexpr unsigned kSeed = 7;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  const Eigen::Matrix3d first = RandomPoseCovariance(0.02, &random);
  const Eigen::Matrix3d second = RandomPoseCovariance(0.01, &random);
  const SE2 step(5.0, -3.0, 2.0);
  const Eigen::Matrix3d L1 = first.llt().matrixL();
  const Eigen::Matrix3d L2 = second.llt().matrixL();
  std::normal_distribution<double> normal;
  const auto draw = [&](const Eigen::Matrix3d& L) {
    const Eigen::Vector3d unit(normal(random), normal(random), normal(random));
    return Eigen::Vector3d(L * unit);
  };
  constexpr int kDraws = 20000;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int i = 0; i < kDraws; ++i) {
    const SE2 end = SE2().Boxplus(draw(L1)) * step.Boxplus(draw(L2));
    const Eigen::Vector3d error = end.Boxminus(step);
    sum += error * error.transpose();
  }
  const Eigen::Matrix3d composed = ComposeCovariances(first, step, second);
  EXPECT_LT((sum / kDraws - composed).norm(), 0.05 * composed.norm());
}

TEST(ComposeCovariances, OfACertainStartIsTheStep) {
  std::mt19937 random(3);
  const Eigen::Matrix3d second = RandomPoseCovariance(0.1, &random);
  const SE2 step = RandomStep(&random);
  EXPECT_LT((ComposeCovariances(Eigen::Matrix3d::Zero(), step, second) - second).norm(), 1e-15);
}

TEST(FuseCovariances, KnowsNoLessThanEitherAndNoMoreThanBoth) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Eigen::Matrix3d a = RandomPoseCovariance(0.3, &random);
    const Eigen::Matrix3d b = RandomPoseCovariance(0.1, &random);
    const Eigen::Matrix3d fused = FuseCovariances(a, b);
    for (const Eigen::Matrix3d& one : {a, b}) {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> gain(one - fused);
      EXPECT_GT(gain.eigenvalues()(0), -1e-12);
    }
    const Eigen::Matrix3d information = a.inverse() + b.inverse();
    EXPECT_LT((fused * information - Eigen::Matrix3d::Identity()).norm(), 1e-9);
  }
}

TEST(FuseCovariances, AnUnknownDirectionIsFilledByTheOther) {
  const Eigen::Matrix3d match = Eigen::Vector3d(400.0, 1e-4, 1e-6).asDiagonal();
  const Eigen::Matrix3d odometry = Eigen::Vector3d(0.01, 0.01, 0.01).asDiagonal();
  const Eigen::Matrix3d fused = FuseCovariances(match, odometry);
  EXPECT_NEAR(fused(0, 0), 0.01, 1e-5);
  EXPECT_NEAR(fused(1, 1), 1e-4, 2e-6);
}

}  // namespace
}  // namespace loopgrid
