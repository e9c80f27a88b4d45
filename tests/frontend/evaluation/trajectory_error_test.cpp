#include "frontend/evaluation/trajectory_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace loopgrid {
namespace {

Trajectory Loop(std::size_t size) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < size; ++i) {
    const double t = 0.1 * static_cast<double>(i);
    trajectory.push_back({t, SE2(5.0 * std::cos(t), 3.0 * std::sin(t), t)});
  }
  return trajectory;
}

TEST(EvaluateTrajectory, ARigidMotionOfTheWholeIsNoError) {
  const Trajectory reference = Loop(60);
  for (const SE2& motion : {SE2(10.0, -20.0, 2.5), SE2(0.0, 0.0, std::numbers::pi), SE2()}) {
    Trajectory estimate = reference;
    for (auto& [timestamp, pose] : estimate) pose = motion * pose;
    const TrajectoryEvaluation evaluation = EvaluateTrajectory(estimate, reference);
    EXPECT_EQ(evaluation.translation.count, 60U);
    EXPECT_EQ(evaluation.unmatched, 0U);
    EXPECT_LT(evaluation.translation.maximum, 1e-9);
    EXPECT_LT(evaluation.rotation.maximum, 1e-9);
    EXPECT_LT((evaluation.T_reference_estimate * motion).coordinates().norm(), 1e-9);
  }
}

TEST(EvaluateTrajectory, DoesNotScale) {
  const Trajectory reference = Loop(60);
  Trajectory estimate = reference;
  for (auto& [timestamp, pose] : estimate) {
    pose = SE2(2.0 * pose.x(), 2.0 * pose.y(), pose.theta());
  }
  EXPECT_GT(EvaluateTrajectory(estimate, reference).translation.mean, 1.0);
}

TEST(EvaluateTrajectory, NoOtherAlignmentHasASmallerSumOfSquares) {
  std::mt19937 random(9);
  std::normal_distribution<double> noise(0.0, 0.3);
  const Trajectory reference = Loop(60);
  Trajectory estimate = reference;
  for (auto& [timestamp, pose] : estimate) {
    pose = SE2(3.0, 1.0, -0.7) *
           SE2(pose.x() + noise(random), pose.y() + noise(random), pose.theta() + noise(random));
  }
  const TrajectoryEvaluation best = EvaluateTrajectory(estimate, reference);
  const auto rms_of = [&](const SE2& alignment) {
    double sum = 0.0;
    for (std::size_t i = 0; i < reference.size(); ++i) {
      sum += ((alignment * estimate[i].pose).translation() - reference[i].pose.translation())
                 .squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(reference.size()));
  };
  EXPECT_NEAR(rms_of(best.T_reference_estimate), best.translation.rms, 1e-12);
  for (const double step : {1e-1, 1e-3}) {
    for (const SE2& change : {SE2(step, 0, 0), SE2(-step, 0, 0), SE2(0, step, 0), SE2(0, -step, 0),
                              SE2(0, 0, step), SE2(0, 0, -step)}) {
      EXPECT_GT(rms_of(change * best.T_reference_estimate), best.translation.rms);
    }
  }
}

TEST(EvaluateTrajectory, RotationsAreComparedAfterAlignment) {
  const Trajectory reference = Loop(10);
  Trajectory estimate = reference;
  for (auto& [timestamp, pose] : estimate) {
    pose = SE2(0.0, 0.0, 1.0) * SE2(pose.x(), pose.y(), pose.theta() + 0.1);
  }
  const TrajectoryEvaluation evaluation = EvaluateTrajectory(estimate, reference);
  EXPECT_NEAR(evaluation.rotation.mean, 0.1 * 180.0 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(evaluation.rotation.standard_deviation, 0.0, 1e-9);
}

TEST(EvaluateTrajectory, ComparesOnlyWhatIsNearInTime) {
  const Trajectory reference = Loop(20);
  Trajectory estimate = reference;
  for (auto& [timestamp, pose] : estimate) timestamp += 0.015;
  estimate.resize(12);
  EXPECT_EQ(EvaluateTrajectory(estimate, reference).translation.count, 12U);
  EXPECT_EQ(EvaluateTrajectory(estimate, reference).unmatched, 8U);
  const TrajectoryEvaluation none = EvaluateTrajectory(estimate, reference, 0.01);
  EXPECT_EQ(none.translation.count, 0U);
  EXPECT_EQ(none.unmatched, 20U);
}

TEST(EvaluateTrajectory, OnePoseAlignsByItsPosition) {
  const TrajectoryEvaluation evaluation =
      EvaluateTrajectory({{1.0, SE2(3.0, 4.0, 0.5)}}, {{1.0, SE2(1.0, 1.0, 0.25)}});
  EXPECT_EQ(evaluation.translation.count, 1U);
  EXPECT_LT(evaluation.translation.maximum, 1e-12);
  EXPECT_NEAR(evaluation.rotation.mean, 0.25 * 180.0 / std::numbers::pi, 1e-9);
}

}  // namespace
}  // namespace loopgrid
