#include "frontend/tracking/odometry_noise.h"

#include <gtest/gtest.h>

#include <cmath>

namespace loopgrid {
namespace {

TEST(OdometryCovariance, OfNoMotionIsTheFloor) {
  const Eigen::Vector3d variances = OdometryCovariance(SE2(), OdometryNoise()).diagonal();
  EXPECT_NEAR((variances - Eigen::Vector3d(1e-4, 1e-4, 1e-4)).norm(), 0.0, 1e-15);
}

TEST(OdometryCovariance, AddsTheDeviationsOfDistanceAndTurn) {
  const OdometryNoise noise{.translation_per_metre = 0.1,
                            .translation_per_radian = 0.2,
                            .rotation_per_metre = 0.3,
                            .rotation_per_radian = 0.4,
                            .translation_floor = 0.01,
                            .rotation_floor = 0.02};
  for (double turn : {-0.5, 0.5}) {
    const Eigen::Matrix3d covariance = OdometryCovariance(SE2(-3.0, 4.0, turn), noise);
    EXPECT_NEAR(std::sqrt(covariance(0, 0)), 0.01 + 0.5 + 0.1, 1e-12);
    EXPECT_NEAR(std::sqrt(covariance(1, 1)), 0.01 + 0.5 + 0.1, 1e-12);
    EXPECT_NEAR(std::sqrt(covariance(2, 2)), 0.02 + 1.5 + 0.2, 1e-12);
    EXPECT_TRUE(covariance.isDiagonal(0.0));
  }
}

}  // namespace
}  // namespace loopgrid
