// An optimiser that is kept: what it knows of the last call's graph must not show where another
// graph is given.

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "backend/graph/constraint_error.h"
#include "backend/solve/optimizer.h"
#include "tests/support/expect_marginals.h"
#include "tests/support/graphs.h"

namespace loopgrid {
namespace {

using test_support::ExpectMarginalsOf;
using test_support::RandomGraph;

template <typename Pose>
class OptimizerReuseTest : public ::testing::Test {
 protected:
  using Graph = PoseGraph<Pose>;
  using Tangent = typename Pose::Tangent;

  struct Change {
    std::string name;
    std::function<void(Graph*)> make;
  };

  static Constraint<Pose> Link(const Graph& graph, int from, int to, double error) {
    Constraint<Pose> link;
    link.from = from;
    link.to = to;
    link.T_from_to = (graph.poses[static_cast<std::size_t>(from)].Inverse() *
                      graph.poses[static_cast<std::size_t>(to)])
                         .Boxplus(Tangent::Constant(error));
    return link;
  }

  /// Appends a node and joins it to the graph, all in agreement.
  static void Grow(Graph* graph) {
    const int node = static_cast<int>(graph->poses.size());
    graph->poses.push_back(graph->poses.back().Boxplus(Tangent::Constant(0.3)));
    graph->constraints.push_back(Link(*graph, node - 1, node, 0.0));
    graph->constraints.push_back(Link(*graph, node, 2, 0.0));
    LandmarkObservation<Pose> seen;
    seen.node = node;
    seen.landmark = static_cast<int>(graph->landmarks.size());
    seen.p_node.setConstant(1.5);
    graph->landmarks.push_back(graph->poses.back() * seen.p_node);
    graph->observations.push_back(seen);
  }

  /// What must not be taken for the minimum that it was.
  static std::vector<Change> OtherChanges() {
    return {
        {"a node that does not agree",
         [](Graph* g) {
           Grow(g);
           g->constraints.back() = Link(*g, 12, 2, 0.05);
         }},
        {"a closure that does not agree",
         [](Graph* g) { g->constraints.push_back(Link(*g, 1, 9, 0.05)); }},
        {"a measurement", [](Graph* g) { g->constraints[13].T_from_to = Pose(); }},
        {"an information matrix", [](Graph* g) { g->constraints[13].information *= 2.0; }},
        {"the ends of a constraint", [](Graph* g) { g->constraints[13] = Link(*g, 3, 8, 0.05); }},
        {"a constraint less", [](Graph* g) { g->constraints.erase(g->constraints.begin() + 13); }},
        {"the last constraint less", [](Graph* g) { g->constraints.pop_back(); }},
        {"a robust constraint", [](Graph* g) { g->constraints[13].robust = true; }},
        {"an observation", [](Graph* g) { g->observations[1].p_node(0) += 0.2; }},
        {"an observation less", [](Graph* g) { g->observations.pop_back(); }},
        {"one more observation",
         [](Graph* g) {
           g->observations.push_back(g->observations[0]);
           g->observations.back().p_node(1) += 0.1;
         }},
        {"a pose", [](Graph* g) { g->poses[5] = g->poses[5].Boxplus(Tangent::Constant(0.02)); }},
        {"a landmark", [](Graph* g) { g->landmarks[2](0) += 0.1; }},
        {"a pose and the fixed node",
         [](Graph* g) {
           g->fixed = {5};
           g->poses[5] = g->poses[5].Boxplus(Tangent::Constant(0.02));
         }},
        {"two fixed nodes",
         [](Graph* g) {
           g->fixed = {0, 7};
         }},
    };
  }

  static OptimizerOptions Options() {
    OptimizerOptions options;
    options.loss = {LossKind::kHuber, 0.1};
    return options;
  }

  Graph graph_ = RandomGraph<Pose>(12, 10, 1, 6);
  Optimizer<Pose> optimizer_{Options()};
  OptimizerResult first_ = optimizer_.Optimize(&graph_);
};

TYPED_TEST_SUITE(OptimizerReuseTest, test_support::AllPoses, test_support::PoseName);

TYPED_TEST(OptimizerReuseTest, StopsAtOnceAtTheMinimum) {
  const auto before = this->graph_;
  const OptimizerResult second = this->optimizer_.Optimize(&this->graph_);
  EXPECT_EQ(this->first_.termination, Termination::kConverged);
  EXPECT_GT(this->first_.iterations, 0);
  EXPECT_EQ(second.termination, Termination::kConverged);
  EXPECT_EQ(second.iterations, 0);
  EXPECT_EQ(second.initial_error, this->first_.final_error);
  EXPECT_EQ(second.final_error, this->first_.final_error);
  EXPECT_EQ(this->graph_, before);
  ExpectMarginalsOf(this->graph_, this->optimizer_.ComputeMarginals(this->graph_));
}

TYPED_TEST(OptimizerReuseTest, TakesNoStepForWhatAgrees) {
  for (int i = 0; i < 3; ++i) {
    this->Grow(&this->graph_);
    const auto before = this->graph_;
    const OptimizerResult result = this->optimizer_.Optimize(&this->graph_);
    EXPECT_EQ(result.termination, Termination::kConverged);
    EXPECT_EQ(result.iterations, 0);
    EXPECT_NEAR(result.final_error, TotalChi2(this->graph_), 1e-12 * result.final_error);
    EXPECT_EQ(this->graph_, before);
    ExpectMarginalsOf(this->graph_, this->optimizer_.ComputeMarginals(this->graph_));
  }
}

TYPED_TEST(OptimizerReuseTest, NoticesEveryOtherChange) {
  using Pose = TypeParam;
  const RobustLoss loss = this->Options().loss;
  for (const auto& change : this->OtherChanges()) {
    SCOPED_TRACE(change.name);
    PoseGraph<Pose> graph = this->graph_;
    this->optimizer_.Optimize(&graph);
    change.make(&graph);
    PoseGraph<Pose> expected = graph;
    const OptimizerResult fresh = Optimizer<Pose>(this->Options()).Optimize(&expected);
    const OptimizerResult result = this->optimizer_.Optimize(&graph);
    EXPECT_EQ(result.termination, Termination::kConverged);
    EXPECT_NEAR(result.initial_error, fresh.initial_error, 1e-12 * fresh.initial_error);
    EXPECT_NEAR(result.final_error, fresh.final_error, 1e-6 * fresh.final_error);
    EXPECT_NEAR(result.final_error, TotalError(graph, {loss}), 1e-12 * fresh.final_error);
    ExpectMarginalsOf(graph, this->optimizer_.ComputeMarginals(graph), loss);
  }
}

TYPED_TEST(OptimizerReuseTest, MarginalsAreThoseOfTheGraphThatIsGiven) {
  const RobustLoss loss = this->Options().loss;
  for (const auto& change : this->OtherChanges()) {
    SCOPED_TRACE(change.name);
    auto changed = this->graph_;
    change.make(&changed);
    ExpectMarginalsOf(changed, this->optimizer_.ComputeMarginals(changed), loss);
    // Back to what was optimised: its factor is no longer there.
    ExpectMarginalsOf(this->graph_, this->optimizer_.ComputeMarginals(this->graph_), loss);
  }
}

TYPED_TEST(OptimizerReuseTest, MarginalsAreOfLocalMotionsInEveryParametrization) {
  for (const auto parametrization : {Parametrization::kExponential, Parametrization::kEuler}) {
    OptimizerOptions options;
    options.parametrization = parametrization;
    Optimizer<TypeParam> optimizer(options);
    optimizer.Optimize(&this->graph_);
    for (int i = 0; i < 2; ++i) {
      ExpectMarginalsOf(this->graph_, optimizer.ComputeMarginals(this->graph_));
    }
  }
}

TYPED_TEST(OptimizerReuseTest, MarginalsAreRightAfterGaussNewtonDiverged) {
  using Pose = TypeParam;
  OptimizerOptions options;
  options.method = Method::kGaussNewton;
  options.max_iterations = 5;
  int diverged = 0;
  for (unsigned seed = 1; seed < 15; ++seed) {
    PoseGraph<Pose> graph = RandomGraph<Pose>(12, 12, seed);
    std::mt19937 random(seed);
    for (Pose& pose : graph.poses) pose = test_support::RandomPose<Pose>(&random);
    Optimizer<Pose> optimizer(options);
    if (optimizer.Optimize(&graph).termination != Termination::kDiverged) continue;
    ++diverged;
    ExpectMarginalsOf(graph, optimizer.ComputeMarginals(graph));
  }
  EXPECT_GT(diverged, 0);
}

}  // namespace
}  // namespace loopgrid
