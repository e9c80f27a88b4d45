#include "backend/solve/optimizer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "backend/base/error.h"
#include "backend/graph/constraint_error.h"
#include "tests/support/effort.h"
#include "tests/support/graphs.h"
#include "tests/support/solvers.h"

namespace loopgrid {
namespace {

using test_support::AppendNextNode;
using test_support::Distance;
using test_support::RandomGraph;
using test_support::RandomPose;

template <typename Pose>
void ExpectSamePlaces(const PoseGraph<Pose>& a, const PoseGraph<Pose>& b, double tolerance) {
  ASSERT_EQ(a.poses.size(), b.poses.size());
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    EXPECT_LE(Distance(a.poses[i], b.poses[i]), tolerance) << "node " << i;
  }
  ASSERT_EQ(a.landmarks.size(), b.landmarks.size());
  for (std::size_t i = 0; i < a.landmarks.size(); ++i) {
    EXPECT_LE((a.landmarks[i] - b.landmarks[i]).norm(), tolerance) << "landmark " << i;
  }
}

/// Newton steps with a dense solver until nothing moves.
template <typename Pose>
void OptimizeDense(PoseGraph<Pose>* graph) {
  constexpr int kDof = Pose::kDof;
  constexpr int kPoint = Pose::Point::RowsAtCompileTime;
  for (int iteration = 0; iteration < 50; ++iteration) {
    const auto [H, b] = test_support::DenseNormalEquations(*graph);
    const std::vector<int> held = HeldNodes(*graph, ConnectedComponents(*graph));
    const Eigen::VectorXd dx = -test_support::InverseWithout(H, held, kDof) * b;
    Eigen::Index row = 0;
    for (Pose& pose : graph->poses) {
      pose = pose.Boxplus(dx.segment<kDof>(row));
      row += kDof;
    }
    for (auto& landmark : graph->landmarks) {
      landmark += dx.segment<kPoint>(row);
      row += kPoint;
    }
    if (dx.norm() < 1e-11) return;
  }
  FAIL() << "the reference does not converge";
}

template <typename S>
class OptimizerTest : public test_support::SolverTest<S> {};

TYPED_TEST_SUITE(OptimizerTest, test_support::AllSolvers, test_support::SolverName);

TYPED_TEST(OptimizerTest, FindsTheMinimumThatDenseNewtonFinds) {
  using Pose = typename TypeParam::Pose;
  for (unsigned seed = 71; seed < test_support::Effort(74U, 72U); ++seed) {
    SCOPED_TRACE(seed);
    PoseGraph<Pose> graph = RandomGraph<Pose>(15, 15, seed, 6);
    PoseGraph<Pose> expected = graph;
    OptimizeDense(&expected);
    const OptimizerResult result = this->Optimize(&graph);
    EXPECT_EQ(result.termination, Termination::kConverged);
    EXPECT_NEAR(result.final_error, TotalChi2(expected), 1e-7 * result.final_error);
    EXPECT_NEAR(result.final_error, TotalChi2(graph), 1e-12 * result.final_error);
    ExpectSamePlaces(graph, expected, 1e-3);
  }
}

TYPED_TEST(OptimizerTest, OptimizesEachComponentOnItsOwn) {
  using Pose = typename TypeParam::Pose;
  PoseGraph<Pose> first = RandomGraph<Pose>(20, 15, 82, 4);
  PoseGraph<Pose> second = RandomGraph<Pose>(15, 10, 83, 3);
  PoseGraph<Pose> both = test_support::Union(first, second);
  both.poses.emplace_back();                // no constraint at all
  both.landmarks.emplace_back().setOnes();  // never seen
  const OptimizerResult result = this->Optimize(&both);
  EXPECT_EQ(result.termination, Termination::kConverged);
  this->Optimize(&first);
  this->Optimize(&second);
  EXPECT_NEAR(result.final_error, TotalChi2(first) + TotalChi2(second), 1e-6);
  PoseGraph<Pose> expected = test_support::Union(first, second);
  expected.poses.emplace_back();
  expected.landmarks.emplace_back().setOnes();
  ExpectSamePlaces(both, expected, 1e-3);
}

TYPED_TEST(OptimizerTest, TwoEqualConstraintsWeighAsOneOfTwiceTheInformation) {
  using Pose = typename TypeParam::Pose;
  PoseGraph<Pose> doubled = RandomGraph<Pose>(15, 10, 84, 3);
  PoseGraph<Pose> heavier = doubled;
  doubled.constraints.push_back(doubled.constraints[18]);
  doubled.observations.push_back(doubled.observations[1]);
  heavier.constraints[18].information *= 2.0;
  heavier.observations[1].information *= 2.0;
  this->Optimize(&doubled);
  this->Optimize(&heavier);
  ExpectSamePlaces(doubled, heavier, 1e-6);
}

TYPED_TEST(OptimizerTest, EveryParametrizationEndsAtTheSameMinimumFromAGoodStart) {
  using Pose = typename TypeParam::Pose;
  const PoseGraph<Pose> start = RandomGraph<Pose>(20, 15, 85, 5);
  PoseGraph<Pose> expected = start;
  this->Optimize(&expected);
  for (const auto parametrization : {Parametrization::kExponential, Parametrization::kEuler}) {
    this->options_.parametrization = parametrization;
    PoseGraph<Pose> graph = start;
    const OptimizerResult result = this->Optimize(&graph);
    EXPECT_EQ(result.termination, Termination::kConverged);
    // The errors of Euler angles are not quite the same.
    const bool is_same = parametrization == Parametrization::kExponential || Pose::kDof == 3;
    EXPECT_NEAR(TotalChi2(graph), TotalChi2(expected),
                (is_same ? 1e-7 : 0.05) * result.final_error);
    ExpectSamePlaces(graph, expected, is_same ? 1e-3 : 0.1);
  }
}

TYPED_TEST(OptimizerTest, EndsWhereTheRobustGradientIsZero) {
  using Pose = typename TypeParam::Pose;
  PoseGraph<Pose> start = RandomGraph<Pose>(20, 20, 86, 5);
  this->Optimize(&start);
  std::mt19937 random(86);
  for (std::size_t k = 19; k < start.constraints.size(); ++k) start.constraints[k].robust = true;
  start.constraints[25].T_from_to = RandomPose<Pose>(&random, 10.0);  // wrong
  for (const LossKind kind :
       {LossKind::kHuber, LossKind::kCauchy, LossKind::kGemanMcClure, LossKind::kDcs}) {
    SCOPED_TRACE(static_cast<int>(kind));
    this->options_.loss = {kind, 2.0};
    PoseGraph<Pose> graph = start;
    const OptimizerResult result = this->Optimize(&graph);
    EXPECT_EQ(result.termination, Termination::kConverged);
    const Objective objective{this->options_.loss};
    EXPECT_NEAR(result.final_error, TotalError(graph, objective), 1e-12 * result.final_error);
    const auto [H, b] = test_support::DenseNormalEquations(graph, objective);
    const Eigen::VectorXd newton = test_support::InverseWithout(H, {0}, Pose::kDof) * b;
    EXPECT_LE(b.tail(b.size() - Pose::kDof).dot(newton.tail(b.size() - Pose::kDof)),
              1e-7 * result.final_error);
  }
}

TYPED_TEST(OptimizerTest, TheTraceTellsOfTheStartAndOfEveryStep) {
  using Pose = typename TypeParam::Pose;
  this->options_.trace = true;
  PoseGraph<Pose> graph = RandomGraph<Pose>(20, 20, 87, 5);
  const OptimizerResult result = this->Optimize(&graph);
  ASSERT_EQ(static_cast<int>(result.trace.size()), result.iterations + 1);
  EXPECT_EQ(result.trace.front().error, result.initial_error);
  EXPECT_EQ(result.trace.back().error, result.final_error);
  EXPECT_EQ(result.trace.front().step, 0.0);
  double last = 0.0;
  for (const IterationRecord& record : result.trace) {
    EXPECT_NEAR(record.chi2, record.error, 1e-12 * record.error);  // no loss, no Euler angles
    EXPECT_GE(record.seconds, last);
    EXPECT_TRUE(record.step > 0.0 || last == 0.0);
    last = record.seconds;
  }
  this->options_.trace = false;
  EXPECT_TRUE(this->Optimize(&graph).trace.empty());
}

TYPED_TEST(OptimizerTest, HasTheSameBitsForAnyNumberOfThreads) {
  using Pose = typename TypeParam::Pose;
  const PoseGraph<Pose> start = RandomGraph<Pose>(2200, 20, 88, 20);
  this->options_.max_iterations = 2;
  PoseGraph<Pose> expected = start;
  this->Optimize(&expected);
  this->options_.threads = 3;
  PoseGraph<Pose> graph = start;
  this->Optimize(&graph);
  EXPECT_EQ(graph, expected);
}

TYPED_TEST(OptimizerTest, LeavesGraphsWithoutAnythingToMoveAlone) {
  using Pose = typename TypeParam::Pose;
  PoseGraph<Pose> empty;
  EXPECT_EQ(this->Optimize(&empty).termination, Termination::kNothingToMove);
  PoseGraph<Pose> scattered;  // nodes without constraints are components of their own
  std::mt19937 random(1);
  for (int i = 0; i < 2; ++i) scattered.poses.push_back(RandomPose<Pose>(&random));
  scattered.landmarks.emplace_back().setOnes();
  const PoseGraph<Pose> before = scattered;
  const OptimizerResult result = this->Optimize(&scattered);
  EXPECT_EQ(result.termination, Termination::kNothingToMove);
  EXPECT_EQ(result.final_error, 0.0);
  EXPECT_EQ(scattered, before);
  PoseGraph<Pose> fixed = RandomGraph<Pose>(3, 0, 81);
  fixed.fixed = {0, 1, 2};
  EXPECT_EQ(this->Optimize(&fixed).termination, Termination::kNothingToMove);
}

template <typename Pose>
class AnyPoseOptimizerTest : public ::testing::Test {};

TYPED_TEST_SUITE(AnyPoseOptimizerTest, test_support::AllPoses, test_support::PoseName);

TYPED_TEST(AnyPoseOptimizerTest, HoldsTheFirstNodeOrTheFixedOnes) {
  PoseGraph<TypeParam> graph = RandomGraph<TypeParam>(20, 10, 76, 4);
  const PoseGraph<TypeParam> before = graph;
  Optimizer<TypeParam>().Optimize(&graph);
  EXPECT_EQ(graph.poses[0], before.poses[0]);
  graph = before;
  graph.fixed = {7, 13};
  Optimizer<TypeParam>().Optimize(&graph);
  EXPECT_EQ(graph.poses[7], before.poses[7]);
  EXPECT_EQ(graph.poses[13], before.poses[13]);
  EXPECT_NE(graph.poses[0], before.poses[0]);
}

TYPED_TEST(AnyPoseOptimizerTest, GrowingGraphEndsWhereTheWholeOneEnds) {
  PoseGraph<TypeParam> whole = RandomGraph<TypeParam>(60, 40, 78, 10);
  PoseGraph<TypeParam> graph;
  Optimizer<TypeParam> optimizer;
  while (graph.poses.size() < whole.poses.size()) {
    AppendNextNode(whole, &graph);
    const std::size_t node = graph.poses.size() - 1;
    if (node > 0) {
      graph.poses[node] = graph.poses[node - 1] * whole.constraints[node - 1].T_from_to;
    }
    const OptimizerResult result = optimizer.Optimize(&graph);
    EXPECT_TRUE(node == 0 || result.termination == Termination::kConverged) << node;
  }
  Optimizer<TypeParam>().Optimize(&whole);
  EXPECT_NEAR(TotalChi2(graph), TotalChi2(whole), 1e-6 * TotalChi2(whole));
  ExpectSamePlaces(graph, whole, 1e-2);
}

TYPED_TEST(AnyPoseOptimizerTest, RefusesGraphsThatAreNotValid) {
  PoseGraph<TypeParam> graph = RandomGraph<TypeParam>(5, 0, 88);
  graph.constraints[2].to = 99;
  EXPECT_THROW(Optimizer<TypeParam>().Optimize(&graph), Error);
}

TYPED_TEST(OptimizerTest, AsksTheObserverAfterEveryStepAndStopsWhereItSays) {
  using Pose = typename TypeParam::Pose;
  const PoseGraph<Pose> start = RandomGraph<Pose>(20, 20, 87, 5);
  this->options_.trace = true;
  PoseGraph<Pose> graph = start;
  const OptimizerResult whole = this->Optimize(&graph);
  ASSERT_GE(whole.iterations, 2);
  for (int last = 0; last < whole.iterations; ++last) {
    std::vector<double> errors;
    graph = start;
    const OptimizerResult result =
        Optimizer<Pose>(this->options_).Optimize(&graph, [&](const IterationRecord& record) {
          errors.push_back(record.error);
          return static_cast<int>(errors.size()) <= last;
        });
    EXPECT_EQ(result.termination, Termination::kCancelled);
    EXPECT_EQ(result.iterations, last);
    EXPECT_NEAR(TotalChi2(graph), result.final_error, 1e-12 * result.final_error);
    ASSERT_EQ(errors.size(), result.trace.size());
    for (std::size_t i = 0; i < errors.size(); ++i) {
      EXPECT_EQ(errors[i], whole.trace[i].error) << "step " << i;
    }
  }
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
  EXPECT_THAT(message([](auto* o) { o->threads = 0; }), HasSubstr("threads is 0"));
  EXPECT_THAT(message([](auto* o) { o->threads = 1000000; }),
              HasSubstr("threads is 1000000, expected 1 to 1024"));
  EXPECT_THAT(message([](auto* o) { o->loss.width = 0.0; }), HasSubstr("width is 0"));
  EXPECT_THAT(message([](auto* o) { o->loss.width = 1e-200; }), HasSubstr("width is 1e-200"));
  EXPECT_THAT(message([](auto* o) { o->loss.width = 1e200; }), HasSubstr("width is 1e+200"));
  EXPECT_THAT(message([](auto* o) { o->loss.width = std::nan(""); }), HasSubstr("width is nan"));
  EXPECT_THAT(message([](auto* o) { o->graduated = true; }), HasSubstr("graduated"));
}

}  // namespace
}  // namespace loopgrid
