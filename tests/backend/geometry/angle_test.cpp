#include "backend/geometry/angle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace loopgrid {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(NormalizeAngle, KeepsWhatIsInRange) {
  for (double angle : {0.0, 1e-9, -1e-9, 1.0, -kPi, std::nextafter(kPi, 0.0)}) {
    EXPECT_EQ(NormalizeAngle(angle), angle);
  }
}

TEST(NormalizeAngle, PiBecomesMinusPi) {
  EXPECT_DOUBLE_EQ(NormalizeAngle(kPi), -kPi);
  EXPECT_NEAR(std::abs(NormalizeAngle(3.0 * kPi)), kPi, 1e-12);
}

TEST(NormalizeAngle, IsAlwaysInHalfOpenRangeAndSameDirection) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angles(-1000.0, 1000.0);
  for (int i = 0; i < 10000; ++i) {
    const double angle = i % 10 == 0 ? kPi * (i / 10 - 500) : angles(random);
    const double normalized = NormalizeAngle(angle);
    ASSERT_GE(normalized, -kPi);
    ASSERT_LT(normalized, kPi);
    ASSERT_NEAR(std::sin(normalized), std::sin(angle), 1e-10) << angle;
    ASSERT_NEAR(std::cos(normalized), std::cos(angle), 1e-10) << angle;
  }
}

TEST(NormalizeAngle, JustBelowMinusPiDoesNotLeaveTheRange) {
  const double below = std::nextafter(-kPi, -4.0);
  EXPECT_GE(NormalizeAngle(below), -kPi);
  EXPECT_LT(NormalizeAngle(below), kPi);
}

TEST(NormalizeAngle, HugeAnglesStayInRange) {
  for (double angle : {1e17, -1e17, 1e300, -1e300}) {
    EXPECT_GE(NormalizeAngle(angle), -kPi) << angle;
    EXPECT_LT(NormalizeAngle(angle), kPi) << angle;
  }
}

}  // namespace
}  // namespace loopgrid
