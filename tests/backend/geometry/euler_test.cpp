#include "backend/geometry/euler.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tests/support/poses.h"

namespace loopgrid {
namespace {

using test_support::RandomVector;

constexpr double kEulerPi = std::numbers::pi;

TEST(RollPitchYaw, UndoesFromRollPitchYaw) {
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d angles =
        RandomVector<Eigen::Vector3d>(&random).cwiseProduct(Eigen::Vector3d(3.1, 1.57, 3.1));
    EXPECT_TRUE(RollPitchYaw(FromRollPitchYaw(angles)).isApprox(angles, 1e-10))
        << angles.transpose();
  }
}

TEST(RollPitchYaw, TurnsAboutTheFixedAxesInTurn) {
  const Eigen::Matrix3d R = FromRollPitchYaw({0.1, 0.2, 0.3}).toRotationMatrix();
  // Roll turns y towards z, pitch z towards x, yaw x towards y.
  EXPECT_NEAR(R(2, 0), -std::sin(0.2), 1e-15);
  EXPECT_NEAR(R(2, 1), std::cos(0.2) * std::sin(0.1), 1e-15);
  EXPECT_NEAR(R(1, 0), std::cos(0.2) * std::sin(0.3), 1e-15);
}

TEST(RollPitchYaw, IsTheSameForBothQuaternionsOfARotation) {
  const Eigen::Quaterniond q = FromRollPitchYaw({2.0, -1.0, 3.0});
  EXPECT_TRUE(RollPitchYaw(Eigen::Quaterniond(-q.coeffs())).isApprox(RollPitchYaw(q), 1e-14));
}

TEST(RollPitchYaw, DescribesTheRotationNearGimbalLockToo) {
  std::mt19937 random(2);
  for (double distance : {0.0, 1e-15, 1e-13, 1e-12, 1e-11, 1e-9, 1e-7, 1e-4}) {
    for (double sign : {1.0, -1.0}) {
      Eigen::Vector3d angles = RandomVector<Eigen::Vector3d>(&random, 3.0);
      angles.y() = sign * (0.5 * kEulerPi - distance);
      const Eigen::Quaterniond q = FromRollPitchYaw(angles);
      const Eigen::Vector3d found = RollPitchYaw(q);
      EXPECT_TRUE(FromRollPitchYaw(found).toRotationMatrix().isApprox(q.toRotationMatrix(), 2e-14))
          << "seed 2, " << distance << " from " << sign * 0.5 * kEulerPi;
      EXPECT_LE(std::abs(found.y()), 0.5 * kEulerPi);
      EXPECT_TRUE(distance > 1e-15 || found.x() == 0.0);
    }
  }
}

TEST(BodyRates, AreTheDerivativeOfTheRotation) {
  std::mt19937 random(3);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d angles = RandomVector<Eigen::Vector3d>(&random, 1.5);
    const Eigen::Matrix3d rates = BodyRates(angles);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(k);
      // q^-1 dq is half the angular velocity in the body's frame.
      const Eigen::Quaterniond turn =
          FromRollPitchYaw(angles - d).conjugate() * FromRollPitchYaw(angles + d);
      EXPECT_TRUE((turn.vec() / kStep).isApprox(rates.col(k), 1e-8)) << "seed 3, case " << i;
    }
  }
}

TEST(BodyRates, AreSingularAtGimbalLock) {
  EXPECT_NEAR(BodyRates({0.3, 0.5 * kEulerPi, 1.0}).determinant(), 0.0, 1e-15);
  EXPECT_NEAR(BodyRates({0.3, 0.0, 1.0}).determinant(), 1.0, 1e-15);
}

}  // namespace
}  // namespace loopgrid
