#include "frontend/evaluation/relation_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tests/support/recordings.h"

namespace loopgrid {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

Trajectory RandomTrajectory(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Trajectory trajectory;
  for (std::size_t i = 0; i < size; ++i) {
    trajectory.push_back(
        {static_cast<double>(i),
         SE2(10.0 * uniform(random), 10.0 * uniform(random), 3.0 * uniform(random))});
  }
  return trajectory;
}

TEST(EvaluateRelations, APerfectTrajectoryHasNoErrorInAnyFrame) {
  const Trajectory truth = RandomTrajectory(50, 1);
  std::vector<Relation> relations;
  for (std::size_t i = 0; i < 50; ++i) {
    const std::size_t k = (i * 7 + 3) % 50;  // t2 often before t1
    relations.push_back(
        {truth[i].timestamp, truth[k].timestamp, truth[i].pose.Inverse() * truth[k].pose});
  }
  Trajectory moved = truth;
  for (auto& [timestamp, pose] : moved) pose = SE2(100.0, -50.0, 2.0) * pose;
  const RelationEvaluation evaluation = EvaluateRelations(moved, relations);
  EXPECT_EQ(evaluation.exact.translation.count, 50U);
  EXPECT_LT(evaluation.exact.translation.maximum, 1e-12);
  EXPECT_LT(evaluation.exact.rotation.maximum, 1e-12);
  EXPECT_EQ(evaluation.interpolated.translation.count, 0U);
  EXPECT_EQ(evaluation.outside, 0U);
}

TEST(EvaluateRelations, TheErrorIsTheDifferenceOfTheComponents) {
  const Trajectory trajectory = {{0.0, SE2(5.0, 5.0, 1.0)},
                                 {1.0, SE2(5.0, 5.0, 1.0) * SE2(1.0, 2.0, 3.1)}};
  // The error is the difference of the components. The given angle does not rotate (dx, dy).
  const std::vector<Relation> relations = {{0.0, 1.0, SE2(1.3, 1.6, -3.1)}};
  const RelationEvaluation evaluation = EvaluateRelations(trajectory, relations);
  ASSERT_EQ(evaluation.errors.size(), 1U);
  EXPECT_NEAR(evaluation.errors[0].translation, 0.5, 1e-12);
  EXPECT_NEAR(evaluation.errors[0].rotation, (2.0 * std::numbers::pi - 6.2) * kDegrees, 1e-9);
}

TEST(EvaluateRelations, ReportsExactAndInterpolatedTimesApart) {
  const Trajectory trajectory = {
      {0.0, SE2(0.0, 0.0, 0.0)}, {1.0, SE2(1.0, 0.0, 0.0)}, {2.0, SE2(2.0, 0.0, 0.0)}};
  const std::vector<Relation> relations = {
      {0.0, 1.00009, SE2(1.0, 0.0, 0.0)},  // within 0.1 ms of a pose
      {0.0, 1.5, SE2(1.25, 0.0, 0.0)},     // between two
      {1.00011, 2.0, SE2(1.0, 0.0, 0.0)},  // just not exact
      {0.0, 2.00009, SE2(2.5, 0.0, 0.0)},  // past the end, but exact
      {0.0, 2.001, SE2(2.0, 0.0, 0.0)},    // past the end
      {-0.5, 1.0, SE2(2.0, 0.0, 0.0)},     // before the beginning
  };
  const RelationEvaluation evaluation = EvaluateRelations(trajectory, relations);
  EXPECT_EQ(evaluation.exact.translation.count, 2U);
  EXPECT_NEAR(evaluation.exact.translation.mean, 0.25, 1e-12);
  EXPECT_NEAR(evaluation.exact.translation.maximum, 0.5, 1e-12);
  EXPECT_EQ(evaluation.interpolated.translation.count, 2U);
  EXPECT_NEAR(evaluation.interpolated.translation.maximum, 0.25, 1e-12);
  EXPECT_EQ(evaluation.outside, 2U);
  ASSERT_EQ(evaluation.errors.size(), 4U);
  EXPECT_EQ(evaluation.errors[3].relation, 3U);
  EXPECT_TRUE(evaluation.errors[3].exact);
  EXPECT_FALSE(evaluation.errors[1].exact);
}

TEST(EvaluateRelations, StandsClocksThatRunBackwards) {
  Trajectory trajectory = RandomTrajectory(40, 2);
  std::vector<Relation> relations;
  for (std::size_t i = 0; i + 1 < 40; ++i) {
    relations.push_back({trajectory[i].timestamp, trajectory[i + 1].timestamp,
                         trajectory[i].pose.Inverse() * trajectory[i + 1].pose});
  }
  std::shuffle(trajectory.begin(), trajectory.end(), std::mt19937(3));
  EXPECT_LT(EvaluateRelations(trajectory, relations).exact.translation.maximum, 1e-12);
}

TEST(EvaluateRelations, WithoutRelationsOrPosesThereIsNothing) {
  EXPECT_EQ(EvaluateRelations(RandomTrajectory(3, 4), {}).errors.size(), 0U);
  const std::vector<Relation> relations(2);
  EXPECT_EQ(EvaluateRelations({}, relations).outside, 2U);
}

// A published solution has the errors that were published for it.
TEST(EvaluateRelations, JudgesPublishedSolutionsAsPublished) {
  LOOPGRID_REQUIRE_RECORDING(intel_relations, "logs/intel-exact.relations");
  LOOPGRID_REQUIRE_RECORDING(intel_reference, "logs/intel.reference.tum");
  LOOPGRID_REQUIRE_RECORDING(killian_relations, "logs/killian.relations");
  LOOPGRID_REQUIRE_RECORDING(killian_reference, "logs/killian.reference.tum");
  const auto intel =
      EvaluateRelations(ReadTumFile(intel_reference), ReadRelationsFile(intel_relations)).exact;
  EXPECT_EQ(intel.translation.count, 290U);
  EXPECT_NEAR(intel.translation.mean, 0.0282, 5e-5);
  EXPECT_NEAR(intel.translation.standard_deviation, 0.0192, 5e-5);
  EXPECT_NEAR(intel.rotation.mean, 0.392, 5e-4);
  EXPECT_NEAR(intel.rotation.standard_deviation, 0.343, 5e-4);
  const auto killian =
      EvaluateRelations(ReadTumFile(killian_reference), ReadRelationsFile(killian_relations)).exact;
  EXPECT_EQ(killian.translation.count, 658U);
  EXPECT_NEAR(killian.translation.mean, 0.0390, 5e-5);
  EXPECT_NEAR(killian.translation.standard_deviation, 0.0326, 5e-5);
  EXPECT_NEAR(killian.rotation.mean, 0.400, 5e-4);
  EXPECT_NEAR(killian.rotation.standard_deviation, 0.339, 5e-4);
}

}  // namespace
}  // namespace loopgrid
