// The optimiser on graphs in which constraints are wrong.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

#include "backend/solve/optimizer.h"
#include "tests/support/effort.h"
#include "tests/support/graphs.h"
#include "tests/support/manhattan_world.h"
#include "tests/support/sphere_world.h"

namespace loopgrid {
namespace {

using test_support::Distance;
using test_support::RandomGraph;
using test_support::RandomPose;

template <typename Pose>
class RobustOptimizerTest : public ::testing::Test {};

TYPED_TEST_SUITE(RobustOptimizerTest, test_support::AllPoses, test_support::PoseName);

TYPED_TEST(RobustOptimizerTest, AConstraintThatIsWrongPullsLess) {
  using Pose = TypeParam;
  PoseGraph<Pose> right = RandomGraph<Pose>(50, 40, 86);
  Optimizer<Pose>().Optimize(&right);
  std::mt19937 random(86);
  Constraint<Pose> wrong;
  wrong.from = 5;
  wrong.to = 45;
  wrong.T_from_to = test_support::PoseWithAngle<Pose>(Pose::Point::Constant(-8.0), 2.0, &random);
  wrong.information *= 100.0;
  PoseGraph<Pose> graph = right;
  graph.constraints.push_back(wrong);
  for (std::size_t k = 49; k < graph.constraints.size(); ++k) graph.constraints[k].robust = true;
  PoseGraph<Pose> quadratic = graph;
  Optimizer<Pose>().Optimize(&quadratic);
  const double pulled = Distance(quadratic.poses[45], right.poses[45]);
  for (const LossKind kind :
       {LossKind::kHuber, LossKind::kCauchy, LossKind::kGemanMcClure, LossKind::kDcs}) {
    OptimizerOptions options;
    options.loss = {kind, 2.0};
    PoseGraph<Pose> robust = graph;
    const OptimizerResult result = Optimizer<Pose>(options).Optimize(&robust);
    EXPECT_EQ(result.termination, Termination::kConverged) << static_cast<int>(kind);
    const double distance = Distance(robust.poses[45], right.poses[45]);
    EXPECT_LT(distance, 0.25 * pulled) << static_cast<int>(kind);
    if (kind == LossKind::kGemanMcClure || kind == LossKind::kDcs) {
      EXPECT_LT(distance, 0.02) << static_cast<int>(kind);
    }
  }
}

TYPED_TEST(RobustOptimizerTest, AGraduatedLossThatLeadsAstrayIsNotFollowed) {
  using Pose = TypeParam;
  // Three measurements agree on where the node is, and four others nearly do on another place:
  // wider losses see more in the four.
  PoseGraph<Pose> graph;
  graph.poses.resize(2);
  for (double x : {0.0, 0.0, 0.0, 20.0, 20.0, 21.0, 21.0}) {
    Constraint<Pose> c{0, 1, {}, Constraint<Pose>::Information::Identity(), true};
    c.T_from_to = Pose(typename Pose::Tangent(x * Pose::Tangent::Unit(0)));
    graph.constraints.push_back(c);
  }
  OptimizerOptions options;
  options.loss = {LossKind::kGemanMcClure, 0.3};
  options.graduated = true;
  const OptimizerResult result = Optimizer<Pose>(options).Optimize(&graph);
  EXPECT_EQ(result.termination, Termination::kConverged);
  EXPECT_LE(result.final_error, result.initial_error);
  EXPECT_LE(Distance(graph.poses[1], Pose()), 0.01);
}

/// What a Geman-McClure loss makes, at once and graduated, of a graph whose odometry is `worse`
/// times as bad as it was and of whose closures three in ten are grossly wrong; and where it ends
/// when it starts at the optimum of the others.
struct OutlierResult {
  double at_once;
  double graduated;
  double from_truth;
  double farthest;  ///< of the graduated poses from the optimum of the right constraints
};

template <typename Pose>
OutlierResult OptimizeWithOutliers(PoseGraph<Pose> graph, double worse, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share;
  PoseGraph<Pose> right = graph;
  right.constraints.clear();
  for (Constraint<Pose>& c : graph.constraints) {
    const bool is_odometry = c.to == c.from + 1;
    c.robust = !is_odometry;
    const bool is_wrong = c.robust && share(random) < 0.3;
    if (is_odometry) {
      c.T_from_to =
          c.T_from_to.Boxplus(5.0 * worse * test_support::RandomNoise(c.information, &random));
      c.information /= 1.0 + worse * worse;
      const auto to = static_cast<std::size_t>(c.to);
      graph.poses[to] = graph.poses[to - 1] * c.T_from_to;
    } else if (is_wrong) {
      c.T_from_to = RandomPose<Pose>(&random, 5.0);
    }
    if (!is_wrong) right.constraints.push_back(c);
  }
  Optimizer<Pose>().Optimize(&right);
  OptimizerOptions options;
  options.loss = {LossKind::kGemanMcClure, 3.0};
  PoseGraph<Pose> end;
  const auto error_from = [&](const std::vector<Pose>& poses) {
    end = graph;
    end.poses = poses;
    return Optimizer<Pose>(options).Optimize(&end).final_error;
  };
  OutlierResult result{error_from(graph.poses), 0.0, error_from(right.poses), 0.0};
  options.graduated = true;
  result.graduated = error_from(graph.poses);
  for (std::size_t i = 0; i < end.poses.size(); ++i) {
    result.farthest = std::max(result.farthest, Distance(end.poses[i], right.poses[i]));
  }
  return result;
}

// A robot that walks through streets of a metre, with odometry that is wrong by 0.2 m and 0.08 rad
// at each of them.
TEST(RobustOptimizer, GraduatedNonConvexityIsRightForEachOf50CitiesWithGrossOutliers) {
  const unsigned seeds = test_support::Effort(50U, 4U);
  unsigned missed_at_once = 0;  // by the loss as it is
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const OutlierResult result =
        OptimizeWithOutliers(test_support::ManhattanWorld(100, 3, seed), 4.0, seed);
    EXPECT_LE(result.graduated, 1.001 * result.from_truth) << "seed " << seed;
    EXPECT_LE(result.graduated, result.at_once) << "seed " << seed;
    EXPECT_LE(result.farthest, 1.0) << "seed " << seed;
    if (result.at_once > 1.001 * result.from_truth) ++missed_at_once;
  }
  EXPECT_GE(missed_at_once, seeds / 2);
}

TEST(RobustOptimizer, GraduatedNonConvexityIsRightOnSpheresWithGrossOutliers) {
  const unsigned seeds = test_support::Effort(12U, 2U);
  unsigned missed_at_once = 0;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const OutlierResult result =
        OptimizeWithOutliers(test_support::SphereWorld(6, 12, 0.05, seed), 2.0, seed);
    EXPECT_LE(result.graduated, 1.001 * result.from_truth) << "seed " << seed;
    EXPECT_LE(result.graduated, result.at_once) << "seed " << seed;
    if (result.at_once > 1.001 * result.from_truth) ++missed_at_once;
  }
  EXPECT_GE(missed_at_once, seeds / 2);
}

/// Half of a city's closures are wrong.
PoseGraph<SE2> CityWithHalfTheClosuresWrong(int nodes, unsigned seed) {
  PoseGraph<SE2> graph = test_support::ManhattanWorld(nodes, 3, seed);
  std::mt19937 random(seed);
  for (Constraint<SE2>& c : graph.constraints) {
    c.robust = c.to != c.from + 1;
    if (c.robust && random() % 2 == 0) c.T_from_to = RandomPose<SE2>(&random, 5.0);
  }
  return graph;
}

TEST(RobustOptimizer, GraduatedNonConvexityTakesFewStepsAndEndsNoHigherThanWithout) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const PoseGraph<SE2> start = CityWithHalfTheClosuresWrong(200, seed);
    OptimizerOptions options;
    options.loss = {LossKind::kGemanMcClure, 3.0};
    PoseGraph<SE2> direct = start;
    const OptimizerResult without = Optimizer<SE2>(options).Optimize(&direct);
    options.graduated = true;
    PoseGraph<SE2> graph = start;
    const OptimizerResult graduated = Optimizer<SE2>(options).Optimize(&graph);
    EXPECT_LE(graduated.final_error, without.final_error) << "seed " << seed;
    EXPECT_EQ(graduated.initial_error, without.initial_error);
    EXPECT_NEAR(TotalError(graph, {options.loss}), graduated.final_error,
                1e-12 * graduated.final_error);
    EXPECT_LE(graduated.iterations, 600) << "seed " << seed;
  }
}

TYPED_TEST(RobustOptimizerTest, EdgesNotMarkedRobustStayQuadratic) {
  OptimizerOptions options;
  options.loss = {LossKind::kGemanMcClure, 0.01};
  PoseGraph<TypeParam> with_loss = RandomGraph<TypeParam>(20, 20, 87, 3);
  PoseGraph<TypeParam> without = with_loss;
  Optimizer<TypeParam>(options).Optimize(&with_loss);
  Optimizer<TypeParam>().Optimize(&without);
  EXPECT_EQ(with_loss, without);
}

}  // namespace
}  // namespace loopgrid
