#include "backend/geometry/se2.h"

#include <gtest/gtest.h>

#include <numbers>

namespace loopgrid {
namespace {

constexpr double kSe2Pi = std::numbers::pi;

// What it shares with SE3 is in group_test.cpp.

TEST(SE2, KeepsItsAngleInOneTurn) {
  EXPECT_EQ(SE2(0.0, 0.0, kSe2Pi).theta(), -kSe2Pi);
  EXPECT_NEAR(SE2(0.0, 0.0, 7.0).theta(), 7.0 - 2.0 * kSe2Pi, 1e-15);
  const SE2 turn(0.0, 0.0, 2.0);
  EXPECT_NEAR((turn * turn).theta(), 4.0 - 2.0 * kSe2Pi, 1e-15);
  EXPECT_EQ(SE2(0.0, 0.0, -kSe2Pi).Inverse().theta(), -kSe2Pi);
}

TEST(SE2, CoordinatesAreNotTheLogarithm) {
  const SE2 pose(1.0, 2.0, 0.5);
  EXPECT_EQ(pose.coordinates(), Eigen::Vector3d(1.0, 2.0, 0.5));
  EXPECT_GT((pose.Log() - pose.coordinates()).norm(), 0.1);
}

TEST(SE2, MovesPointsAsDrawnOnPaper) {
  const SE2 left(3.0, 1.0, 0.5 * kSe2Pi);
  EXPECT_TRUE((left * Eigen::Vector2d(2.0, 0.0)).isApprox(Eigen::Vector2d(3.0, 3.0), 1e-15));
  EXPECT_EQ(left.cos(), std::cos(0.5 * kSe2Pi));
  EXPECT_EQ(left.sin(), 1.0);
}

}  // namespace
}  // namespace loopgrid
