// The optimiser on graphs that are hard for it: nonsensical starts, steps that overshoot,
// directions that no constraint says anything about, numbers that overflow.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

#include "backend/graph/constraint_error.h"
#include "backend/solve/optimizer.h"
#include "tests/support/graphs.h"
#include "tests/support/solvers.h"
#include "tests/support/sphere_world.h"

namespace loopgrid {
namespace {

using test_support::RandomGraph;
using test_support::RandomPose;

/// Poses that have nothing to do with the constraints.
template <typename Pose>
PoseGraph<Pose> NonsenseStart(unsigned seed) {
  PoseGraph<Pose> graph = RandomGraph<Pose>(25, 25, seed, 5);
  std::mt19937 random(seed);
  for (Pose& pose : graph.poses) pose = RandomPose<Pose>(&random, 30.0);
  return graph;
}

template <typename S>
class HardGraphTest : public test_support::SolverTest<S> {};

TYPED_TEST_SUITE(HardGraphTest, test_support::AllSolvers, test_support::SolverName);

TYPED_TEST(HardGraphTest, NeverEndsHigherThanItStarted) {
  using Pose = typename TypeParam::Pose;
  for (unsigned seed = 100; seed < 115; ++seed) {
    SCOPED_TRACE(seed);
    PoseGraph<Pose> graph = NonsenseStart<Pose>(seed);
    const double before = TotalChi2(graph);
    const OptimizerResult result = this->Optimize(&graph);
    EXPECT_NEAR(result.initial_error, before, 1e-12 * before);
    EXPECT_LE(result.final_error, result.initial_error);
    EXPECT_NEAR(result.final_error, TotalChi2(graph), 1e-12 * result.final_error);
  }
}

TYPED_TEST(HardGraphTest, TakesNoMoreStepsThanAllowed) {
  using Pose = typename TypeParam::Pose;
  for (int most = 0; most <= 6; ++most) {
    for (unsigned seed = 120; seed < 126; ++seed) {
      PoseGraph<Pose> graph = NonsenseStart<Pose>(seed);
      const PoseGraph<Pose> before = graph;
      this->options_.max_iterations = most;
      const OptimizerResult result = this->Optimize(&graph);
      EXPECT_LE(result.iterations, most) << "seed " << seed;
      if (most > 0) continue;
      EXPECT_EQ(result.termination, Termination::kMaxIterations);
      EXPECT_EQ(graph, before);
    }
  }
}

TYPED_TEST(HardGraphTest, LeavesAGraphAloneWhoseErrorOverflows) {
  using Pose = typename TypeParam::Pose;
  using Tangent = typename Pose::Tangent;
  PoseGraph<Pose> graph = RandomGraph<Pose>(5, 2, 90);
  graph.poses[3] = Pose(Tangent(1e200 * Tangent::Unit(0)));
  const PoseGraph<Pose> before = graph;
  for (const LossKind kind : {LossKind::kQuadratic, LossKind::kGemanMcClure, LossKind::kDcs}) {
    for (Constraint<Pose>& constraint : graph.constraints) constraint.robust = true;
    this->options_.loss = {kind, 3.0};
    this->options_.graduated = kind == LossKind::kGemanMcClure;
    const OptimizerResult result = this->Optimize(&graph);
    EXPECT_EQ(result.termination, Termination::kNotFinite);
    EXPECT_TRUE(std::isinf(result.initial_error));
    EXPECT_TRUE(std::isinf(result.final_error));
    EXPECT_EQ(graph.poses, before.poses);
  }
}

TYPED_TEST(HardGraphTest, ANumberThatIsLargeButNotInfiniteDoesNoHarm) {
  using Pose = typename TypeParam::Pose;
  using Tangent = typename Pose::Tangent;
  for (const double far : {1e20, 1e70, 1e140}) {
    PoseGraph<Pose> graph = RandomGraph<Pose>(6, 3, 91);
    graph.poses[3] = Pose(Tangent(far * Tangent::Unit(0)));
    const OptimizerResult result = this->Optimize(&graph);
    EXPECT_LE(result.final_error, result.initial_error) << far;
    for (const Pose& pose : graph.poses) EXPECT_TRUE(pose.IsFinite()) << far;
    PoseGraph<Pose> huge = RandomGraph<Pose>(6, 3, 91);
    for (Constraint<Pose>& c : huge.constraints) c.information *= far * far;
    const OptimizerResult other = this->Optimize(&huge);
    EXPECT_LE(other.final_error, other.initial_error) << far;
    for (const Pose& pose : huge.poses) EXPECT_TRUE(pose.IsFinite()) << far;
  }
}

template <typename Pose>
class HardGraphOfAnyPoseTest : public ::testing::Test {};

TYPED_TEST_SUITE(HardGraphOfAnyPoseTest, test_support::AllPoses, test_support::PoseName);

TYPED_TEST(HardGraphOfAnyPoseTest, TheDogLegNeverGoesUphill) {
  OptimizerOptions options;
  options.method = Method::kDogLeg;
  options.trace = true;
  for (unsigned seed = 130; seed < 145; ++seed) {
    PoseGraph<TypeParam> graph = NonsenseStart<TypeParam>(seed);
    const OptimizerResult result = Optimizer<TypeParam>(options).Optimize(&graph);
    EXPECT_EQ(result.uphill_steps, 0);
    for (std::size_t i = 1; i < result.trace.size(); ++i) {
      EXPECT_LT(result.trace[i].error, result.trace[i - 1].error) << "seed " << seed;
    }
  }
}

TYPED_TEST(HardGraphOfAnyPoseTest, GaussNewtonSaysThatItWentUphillAndReturnsToTheBestPoint) {
  OptimizerOptions options;
  options.method = Method::kGaussNewton;
  options.trace = true;
  options.max_iterations = 15;
  int diverged = 0;
  for (unsigned seed = 150; seed < 170; ++seed) {
    SCOPED_TRACE(seed);
    PoseGraph<TypeParam> graph = NonsenseStart<TypeParam>(seed);
    const OptimizerResult result = Optimizer<TypeParam>(options).Optimize(&graph);
    int uphill = 0;
    double lowest = result.initial_error;
    for (std::size_t i = 1; i < result.trace.size(); ++i) {
      if (result.trace[i].error > result.trace[i - 1].error) ++uphill;
      lowest = std::min(lowest, result.trace[i].error);
    }
    EXPECT_EQ(result.uphill_steps, uphill);
    EXPECT_NEAR(TotalChi2(graph), result.final_error, 1e-12 * result.final_error);
    if (result.termination != Termination::kDiverged) continue;
    ++diverged;
    EXPECT_GT(uphill, 0);
    EXPECT_EQ(result.final_error, lowest);
  }
  EXPECT_GT(diverged, 0);
}

TEST(HardGraph, DoesNotGoToAndFroWhereStepsOvershoot) {
  PoseGraph<SE2> graph = RandomGraph<SE2>(12, 10, 1, 6);
  Optimizer<SE2>().Optimize(&graph);
  graph.constraints[13].T_from_to = SE2();  // grossly wrong: the optimum is far from any fit
  const OptimizerResult result = Optimizer<SE2>().Optimize(&graph);
  EXPECT_EQ(result.termination, Termination::kConverged);
  EXPECT_LE(result.iterations, 40);
}

TYPED_TEST(HardGraphOfAnyPoseTest, DampsWhereTheConstraintsLeaveADirectionFree) {
  using Pose = TypeParam;
  using Tangent = typename Pose::Tangent;
  for (const Method method : {Method::kLevenbergMarquardt, Method::kDogLeg}) {
    PoseGraph<Pose> graph = RandomGraph<Pose>(10, 0, 85);
    Tangent weights = Tangent::Ones();
    weights(1) = 0.0;
    graph.constraints[4].information = weights.asDiagonal();
    graph.constraints[4].T_from_to = Pose(Tangent(5.0 * Tangent::Unit(0) + 5.0 * Tangent::Unit(1)));
    OptimizerOptions options;
    options.method = method;
    const OptimizerResult result = Optimizer<Pose>(options).Optimize(&graph);
    EXPECT_EQ(result.termination, Termination::kConverged);
    EXPECT_LT(result.final_error, 1e-6);
    options.method = Method::kGaussNewton;
    graph = RandomGraph<Pose>(10, 0, 85);
    graph.constraints[4].information = weights.asDiagonal();
    EXPECT_EQ(Optimizer<Pose>(options).Optimize(&graph).termination, Termination::kIndefinite);
  }
}

TYPED_TEST(HardGraphOfAnyPoseTest, ANodeOfWhichConstraintsSayNothingDoesNotStopTheOthers) {
  using Information = typename Constraint<TypeParam>::Information;
  PoseGraph<TypeParam> graph = RandomGraph<TypeParam>(20, 15, 89);
  PoseGraph<TypeParam> expected = graph;
  Optimizer<TypeParam>().Optimize(&expected);
  graph.poses.emplace_back();
  graph.constraints.push_back({19, 20, {}, Information::Zero()});
  Optimizer<TypeParam> optimizer;
  const OptimizerResult result = optimizer.Optimize(&graph);
  EXPECT_EQ(result.termination, Termination::kConverged);
  EXPECT_NEAR(result.final_error, TotalChi2(expected), 1e-6 * result.final_error);
  EXPECT_FALSE(optimizer.ComputeMarginals(graph).has_value());
}

// Figure 12 of the tutorial.
TEST(HardGraph, ComesRoundTheSphereOnTheManifoldButNotInEulerAngles) {
  const PoseGraph<SE3> start = test_support::SphereWorld(12, 24, 0.2, 1);
  OptimizerOptions options;
  options.method = Method::kGaussNewton;
  options.max_iterations = 30;
  PoseGraph<SE3> graph = start;
  const OptimizerResult manifold = Optimizer<SE3>(options).Optimize(&graph);
  EXPECT_EQ(manifold.termination, Termination::kConverged);
  // As many squared standard deviations as there are more measurements than unknowns.
  const double expected = 6.0 * static_cast<double>(graph.constraints.size() - graph.poses.size());
  EXPECT_NEAR(manifold.final_error, expected, 6.0 * std::sqrt(2.0 * expected));
  for (const Method method : {Method::kGaussNewton, Method::kLevenbergMarquardt}) {
    options.method = method;
    options.parametrization = Parametrization::kEuler;
    graph = start;
    const OptimizerResult euler = Optimizer<SE3>(options).Optimize(&graph);
    EXPECT_GT(euler.final_error, 3.0 * manifold.final_error) << static_cast<int>(method);
    EXPECT_LE(euler.final_error, euler.initial_error);
  }
}

}  // namespace
}  // namespace loopgrid
