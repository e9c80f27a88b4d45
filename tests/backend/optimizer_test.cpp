#include "backend/optimizer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>

#include "backend/base/error.h"
#include "backend/constraint_error.h"
#include "tests/support/graphs.h"

namespace loopgrid {
namespace {

void ExpectSamePoses(const PoseGraph<SE2>& a, const PoseGraph<SE2>& b, double tolerance) {
  ASSERT_EQ(a.poses.size(), b.poses.size());
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    Eigen::Vector3d difference = a.poses[i].coordinates() - b.poses[i].coordinates();
    difference.z() = NormalizeAngle(difference.z());
    EXPECT_LE(difference.norm(), tolerance) << "node " << i;
  }
}

/// Newton steps with a dense solver until nothing moves.
void OptimizeDense(PoseGraph<SE2>* graph, int held) {
  for (int iteration = 0; iteration < 30; ++iteration) {
    const auto size = static_cast<Eigen::Index>(3 * graph->poses.size());
    Eigen::VectorXd b = Eigen::VectorXd::Zero(size);
    for (const Constraint<SE2>& c : graph->constraints) {
      const LinearizedConstraint<SE2> linear =
          Linearize(graph->poses[static_cast<std::size_t>(c.from)],
                    graph->poses[static_cast<std::size_t>(c.to)], c.T_from_to);
      b.segment<3>(3 * c.from) += linear.J_from.transpose() * c.information * linear.error;
      b.segment<3>(3 * c.to) += linear.J_to.transpose() * c.information * linear.error;
    }
    const Eigen::VectorXd dx =
        -test_support::InverseWithout(test_support::DenseHessian(*graph), {held}, 3) * b;
    for (std::size_t i = 0; i < graph->poses.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(3 * i);
      graph->poses[i] = graph->poses[i].Boxplus(dx.segment<3>(row));
    }
    if (dx.norm() < 1e-12) return;
  }
  FAIL() << "the reference does not converge";
}

TEST(Optimizer, FindsTheMinimumThatDenseNewtonFinds) {
  for (unsigned seed = 71; seed < 76; ++seed) {
    PoseGraph<SE2> graph = test_support::RandomGraph(40, 30, seed);
    PoseGraph<SE2> expected = graph;
    OptimizeDense(&expected, 0);
    const OptimizerResult result = Optimizer<SE2>().Optimize(&graph);
    EXPECT_EQ(result.termination, Termination::kConverged);
    EXPECT_NEAR(result.final_error, TotalChi2(expected), 1e-7 * result.final_error);
    EXPECT_DOUBLE_EQ(result.final_error, TotalChi2(graph));
    ExpectSamePoses(graph, expected, 1e-3);
  }
}

TEST(Optimizer, HoldsTheFirstNodeOrTheFixedOnes) {
  PoseGraph<SE2> graph = test_support::RandomGraph(20, 10, 76);
  const PoseGraph<SE2> before = graph;
  Optimizer<SE2>().Optimize(&graph);
  EXPECT_EQ(graph.poses[0].coordinates(), before.poses[0].coordinates());
  graph = before;
  graph.fixed = {7, 13};
  Optimizer<SE2>().Optimize(&graph);
  EXPECT_EQ(graph.poses[7].coordinates(), before.poses[7].coordinates());
  EXPECT_EQ(graph.poses[13].coordinates(), before.poses[13].coordinates());
  EXPECT_NE(graph.poses[0].coordinates(), before.poses[0].coordinates());
}

TEST(Optimizer, StopsAtOnceAtTheMinimum) {
  PoseGraph<SE2> graph = test_support::RandomGraph(30, 20, 77);
  Optimizer<SE2> optimizer;
  const OptimizerResult first = optimizer.Optimize(&graph);
  const PoseGraph<SE2> at_minimum = graph;
  const OptimizerResult second = optimizer.Optimize(&graph);
  EXPECT_GT(first.iterations, 0);
  EXPECT_EQ(second.iterations, 0);
  EXPECT_EQ(second.termination, Termination::kConverged);
  EXPECT_EQ(second.initial_error, first.final_error);
  ExpectSamePoses(graph, at_minimum, 0.0);
}

TEST(Optimizer, GrowingGraphEndsWhereTheWholeOneEnds) {
  PoseGraph<SE2> whole = test_support::RandomGraph(80, 60, 78);
  PoseGraph<SE2> graph;
  Optimizer<SE2> optimizer;
  for (int node = 0; node < 80; ++node) {
    graph.poses.push_back(
        node == 0
            ? whole.poses[0]
            : graph.poses.back() * whole.constraints[static_cast<std::size_t>(node - 1)].T_from_to);
    for (const Constraint<SE2>& constraint : whole.constraints) {
      if (std::max(constraint.from, constraint.to) == node) graph.constraints.push_back(constraint);
    }
    const OptimizerResult result = optimizer.Optimize(&graph);
    EXPECT_TRUE(node == 0 || result.termination == Termination::kConverged);
  }
  Optimizer<SE2>().Optimize(&whole);
  EXPECT_NEAR(TotalChi2(graph), TotalChi2(whole), 1e-6 * TotalChi2(whole));
  ExpectSamePoses(graph, whole, 1e-2);
}

TEST(Optimizer, NeverEndsHigherThanItStarted) {
  std::mt19937 random(79);
  std::uniform_real_distribution<double> place(-30.0, 30.0);
  for (unsigned seed = 100; seed < 120; ++seed) {
    PoseGraph<SE2> graph = test_support::RandomGraph(25, 25, seed);
    for (SE2& pose : graph.poses) {  // a start that is nonsense
      const double x = place(random);
      const double y = place(random);
      pose = SE2(x, y, place(random));
    }
    const double before = TotalChi2(graph);
    const OptimizerResult result = Optimizer<SE2>().Optimize(&graph);
    EXPECT_DOUBLE_EQ(result.initial_error, before);
    EXPECT_LE(result.final_error, before);
    EXPECT_DOUBLE_EQ(result.final_error, TotalChi2(graph)) << "seed " << seed;
  }
}

TEST(Optimizer, StopsWhenTheIterationsAreUsedUp) {
  PoseGraph<SE2> graph = test_support::RandomGraph(60, 40, 80);
  OptimizerOptions options;
  options.max_iterations = 0;
  const PoseGraph<SE2> before = graph;
  OptimizerResult result = Optimizer<SE2>(options).Optimize(&graph);
  EXPECT_EQ(result.termination, Termination::kMaxIterations);
  ExpectSamePoses(graph, before, 0.0);
  options.max_iterations = 1;
  result = Optimizer<SE2>(options).Optimize(&graph);
  EXPECT_EQ(result.iterations, 1);
  EXPECT_EQ(result.termination, Termination::kMaxIterations);
  EXPECT_LT(result.final_error, result.initial_error);
}

TEST(Optimizer, LeavesGraphsWithoutAnythingToMoveAlone) {
  PoseGraph<SE2> empty;
  EXPECT_EQ(Optimizer<SE2>().Optimize(&empty).termination, Termination::kNothingToMove);
  PoseGraph<SE2> scattered;  // nodes without constraints are components of their own
  scattered.poses = {SE2(1, 2, 3), SE2(4, 5, 6)};
  const PoseGraph<SE2> before = scattered;
  const OptimizerResult result = Optimizer<SE2>().Optimize(&scattered);
  EXPECT_EQ(result.termination, Termination::kNothingToMove);
  EXPECT_EQ(result.final_error, 0.0);
  ExpectSamePoses(scattered, before, 0.0);
  PoseGraph<SE2> fixed = test_support::RandomGraph(3, 0, 81);
  fixed.fixed = {0, 1, 2};
  EXPECT_EQ(Optimizer<SE2>().Optimize(&fixed).termination, Termination::kNothingToMove);
}

TEST(Optimizer, OptimizesEachComponentOnItsOwn) {
  PoseGraph<SE2> first = test_support::RandomGraph(20, 15, 82);
  PoseGraph<SE2> second = test_support::RandomGraph(15, 10, 83);
  PoseGraph<SE2> both = first;
  both.poses.insert(both.poses.end(), second.poses.begin(), second.poses.end());
  for (Constraint<SE2> constraint : second.constraints) {
    constraint.from += 20;
    constraint.to += 20;
    both.constraints.push_back(constraint);
  }
  both.poses.emplace_back(9.0, 9.0, 0.9);  // no constraint at all
  Optimizer<SE2>().Optimize(&first);
  Optimizer<SE2>().Optimize(&second);
  const OptimizerResult result = Optimizer<SE2>().Optimize(&both);
  EXPECT_EQ(result.termination, Termination::kConverged);
  EXPECT_NEAR(result.final_error, TotalChi2(first) + TotalChi2(second), 1e-6);
  first.poses.insert(first.poses.end(), second.poses.begin(), second.poses.end());
  first.poses.emplace_back(9.0, 9.0, 0.9);
  ExpectSamePoses(both, first, 1e-3);
}

TEST(Optimizer, TwoEqualConstraintsWeighAsOneOfTwiceTheInformation) {
  PoseGraph<SE2> doubled = test_support::RandomGraph(15, 10, 84);
  PoseGraph<SE2> heavier = doubled;
  doubled.constraints.push_back(doubled.constraints[18]);
  heavier.constraints[18].information *= 2.0;
  Optimizer<SE2>().Optimize(&doubled);
  Optimizer<SE2>().Optimize(&heavier);
  ExpectSamePoses(doubled, heavier, 1e-6);
}

TEST(Optimizer, DampsWhereTheConstraintsLeaveADirectionFree) {
  PoseGraph<SE2> graph = test_support::RandomGraph(10, 0, 85);
  graph.constraints[4].information = Eigen::Vector3d(1.0, 0.0, 1.0).asDiagonal();
  graph.constraints[4].T_from_to = SE2(5.0, 5.0, 0.0);
  const OptimizerResult result = Optimizer<SE2>().Optimize(&graph);
  EXPECT_EQ(result.termination, Termination::kConverged);
  EXPECT_LT(result.final_error, 1e-6);
}

TEST(Optimizer, ANodeOfWhichConstraintsSayNothingDoesNotStopTheOthers) {
  PoseGraph<SE2> graph = test_support::RandomGraph(20, 15, 89);
  PoseGraph<SE2> expected = graph;
  Optimizer<SE2>().Optimize(&expected);
  graph.poses.emplace_back(7.0, 8.0, 0.5);
  graph.constraints.push_back({19, 20, SE2(1.0, 0.0, 0.0), Eigen::Matrix3d::Zero()});
  Optimizer<SE2> optimizer;
  const OptimizerResult result = optimizer.Optimize(&graph);
  EXPECT_EQ(result.termination, Termination::kConverged);
  EXPECT_NEAR(result.final_error, TotalChi2(expected), 1e-6 * result.final_error);
  EXPECT_FALSE(optimizer.ComputeMarginals(graph).has_value());
}

TEST(Optimizer, AConstraintThatIsWrongPullsLessWithARobustLoss) {
  PoseGraph<SE2> graph = test_support::RandomGraph(50, 40, 86);
  PoseGraph<SE2> right = graph;
  Optimizer<SE2>().Optimize(&right);
  Constraint<SE2> wrong{5, 45, SE2(8.0, -8.0, 2.0), 100.0 * Eigen::Matrix3d::Identity()};
  graph.constraints.push_back(wrong);
  for (std::size_t k = 49; k < graph.constraints.size(); ++k) graph.constraints[k].robust = true;

  PoseGraph<SE2> quadratic = graph;
  Optimizer<SE2>().Optimize(&quadratic);
  const auto distance = [&right](const PoseGraph<SE2>& estimate) {
    return (estimate.poses[45].translation() - right.poses[45].translation()).norm();
  };
  for (const LossKind kind :
       {LossKind::kHuber, LossKind::kCauchy, LossKind::kGemanMcClure, LossKind::kDcs}) {
    OptimizerOptions options;
    options.loss = {kind, 2.0};
    PoseGraph<SE2> robust = graph;
    robust.poses = right.poses;
    const OptimizerResult result = Optimizer<SE2>(options).Optimize(&robust);
    EXPECT_EQ(result.termination, Termination::kConverged) << static_cast<int>(kind);
    EXPECT_LT(distance(robust), 0.25 * distance(quadratic)) << static_cast<int>(kind);
    if (kind == LossKind::kGemanMcClure || kind == LossKind::kDcs) {
      EXPECT_LT(distance(robust), 0.01) << static_cast<int>(kind);
    }
  }
}

TEST(Optimizer, ConstraintsNotMarkedRobustStayQuadratic) {
  OptimizerOptions options;
  options.loss = {LossKind::kGemanMcClure, 0.01};
  PoseGraph<SE2> with_loss = test_support::RandomGraph(20, 20, 87);
  PoseGraph<SE2> without = with_loss;
  Optimizer<SE2>(options).Optimize(&with_loss);
  Optimizer<SE2>().Optimize(&without);
  ExpectSamePoses(with_loss, without, 0.0);
}

TEST(Optimizer, RefusesGraphsThatAreNotValid) {
  PoseGraph<SE2> graph = test_support::RandomGraph(5, 0, 88);
  graph.constraints[2].to = 99;
  EXPECT_THROW(Optimizer<SE2>().Optimize(&graph), Error);
}

TEST(OptimizerOptions, NameWhatIsOutOfRange) {
  const auto message = [](auto change) {
    OptimizerOptions options;
    change(&options);
    try {
      Optimizer<SE2> optimizer(options);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kUsage);
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  using ::testing::HasSubstr;
  EXPECT_THAT(message([](auto* o) { o->max_iterations = -1; }), HasSubstr("max_iterations is -1"));
  EXPECT_THAT(message([](auto* o) { o->relative_decrease = -0.5; }),
              HasSubstr("relative_decrease is -0.5"));
  EXPECT_THAT(message([](auto* o) { o->absolute_decrease = std::nan(""); }),
              HasSubstr("absolute_decrease is nan"));
  EXPECT_THAT(message([](auto* o) { o->loss.width = 0.0; }), HasSubstr("width is 0"));
}

}  // namespace
}  // namespace loopgrid
