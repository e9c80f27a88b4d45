#include "backend/constraint_error.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tests/support/graphs.h"

namespace loopgrid {
namespace {

constexpr double kPi = std::numbers::pi;

SE2 RandomPose(std::mt19937* random) {
  std::uniform_real_distribution<double> place(-20.0, 20.0);
  std::uniform_real_distribution<double> angle(-kPi, kPi);
  const double x = place(*random);
  const double y = place(*random);
  return SE2(x, y, angle(*random));
}

TEST(ConstraintError, IsTheDisplacementSeenFromTheMeasuredPose) {
  std::mt19937 random(11);
  for (int i = 0; i < 200; ++i) {
    const SE2 from = RandomPose(&random);
    const SE2 to = RandomPose(&random);
    const SE2 measured = RandomPose(&random);
    const SE2 by_composition = measured.Inverse() * (from.Inverse() * to);
    const SE2 error(ConstraintError(from, to, measured));
    EXPECT_TRUE((by_composition.Boxminus(error)).isZero(1e-12)) << "seed 11, case " << i;
    EXPECT_EQ(Linearize(from, to, measured).error, error.coordinates());
  }
}

TEST(ConstraintError, IsZeroWhereTheMeasurementIsRight) {
  const SE2 from(3.0, -2.0, 2.9);
  const SE2 measured(1.0, 0.5, 0.6);
  EXPECT_TRUE(ConstraintError(from, from * measured, measured).isZero(1e-14));
}

TEST(Linearize, AgreesWithNumericDerivatives) {
  std::mt19937 random(12);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 200; ++i) {
    const SE2 from = RandomPose(&random);
    const SE2 to = RandomPose(&random);
    const SE2 measured = RandomPose(&random);
    const LinearizedConstraint<SE2> linear = Linearize(from, to, measured);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(k);
      Eigen::Vector3d by_from = ConstraintError(from.Boxplus(d), to, measured) -
                                ConstraintError(from.Boxplus(-d), to, measured);
      Eigen::Vector3d by_to = ConstraintError(from, to.Boxplus(d), measured) -
                              ConstraintError(from, to.Boxplus(-d), measured);
      by_from.z() = NormalizeAngle(by_from.z());
      by_to.z() = NormalizeAngle(by_to.z());
      EXPECT_TRUE((by_from / (2.0 * kStep)).isApprox(linear.J_from.col(k), 1e-7))
          << "seed 12, case " << i << ", column " << k;
      EXPECT_TRUE((by_to / (2.0 * kStep)).isApprox(linear.J_to.col(k), 1e-7))
          << "seed 12, case " << i << ", column " << k;
    }
  }
}

// What makes a choice of the held node a mere choice: see Marginals::RelativeTo.
TEST(Linearize, ErrorsDoNotChangeWhenBothNodesMoveTogether) {
  std::mt19937 random(13);
  for (int i = 0; i < 50; ++i) {
    const SE2 from = RandomPose(&random);
    const SE2 to = RandomPose(&random);
    const LinearizedConstraint<SE2> linear = Linearize(from, to, RandomPose(&random));
    const Eigen::Matrix3d change =
        linear.J_from * from.Inverse().Adjoint() + linear.J_to * to.Inverse().Adjoint();
    EXPECT_TRUE(change.isZero(1e-12)) << "seed 13, case " << i;
  }
}

TEST(TotalChi2, SumsTheSquaredErrorsInStandardDeviations) {
  PoseGraph<SE2> graph;
  graph.poses = {SE2(), SE2(1.0, 0.0, 0.0), SE2(1.0, 3.0, 0.0)};
  Constraint<SE2> along{0, 1, SE2(0.5, 0.0, 0.0), Eigen::Vector3d(4.0, 1.0, 1.0).asDiagonal()};
  Constraint<SE2> across{1, 2, SE2(0.0, 2.0, 0.0), Eigen::Vector3d(1.0, 9.0, 1.0).asDiagonal()};
  graph.constraints = {along, across};
  EXPECT_DOUBLE_EQ(Chi2(graph, along), 1.0);
  EXPECT_DOUBLE_EQ(Chi2(graph, across), 9.0);
  EXPECT_DOUBLE_EQ(TotalChi2(graph), 10.0);
}

}  // namespace
}  // namespace loopgrid
