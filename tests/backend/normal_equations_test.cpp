#include "backend/normal_equations.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "backend/constraint_error.h"
#include "tests/support/block_matrices.h"
#include "tests/support/graphs.h"

namespace loopgrid {
namespace {

/// Rows and columns of the variables, taken from a matrix over all nodes.
Eigen::MatrixXd Reduce(const Eigen::MatrixXd& H, const NormalEquations<SE2>& equations, int nodes) {
  std::vector<Eigen::Index> kept;
  for (int i = 0; i < 3 * nodes; ++i) {
    if (equations.variable(i / 3) >= 0) kept.push_back(i);
  }
  return H(kept, kept);
}

PoseGraph<SE2> GraphWithDuplicates(unsigned seed) {
  PoseGraph<SE2> graph = test_support::RandomGraph(25, 20, seed);
  graph.constraints.push_back(graph.constraints[3]);
  graph.constraints.push_back(graph.constraints[20]);
  std::swap(graph.constraints.back().from, graph.constraints.back().to);
  return graph;
}

TEST(NormalEquations, HessianIsTheSumOverConstraintsWithoutTheHeldNode) {
  PoseGraph<SE2> graph = GraphWithDuplicates(51);
  for (const std::vector<int>& fixed : {std::vector<int>{}, std::vector<int>{4, 24}}) {
    graph.fixed = fixed;
    NormalEquations<SE2> equations;
    EXPECT_TRUE(equations.SetStructure(graph));
    equations.Linearize(graph, {});
    EXPECT_TRUE(test_support::Dense(equations.hessian())
                    .isApprox(Reduce(test_support::DenseHessian(graph), equations, 25), 1e-12));
  }
}

TEST(NormalEquations, GradientIsTheDerivativeOfHalfF) {
  const Objective objective{{LossKind::kCauchy, 1.0}};
  PoseGraph<SE2> graph = GraphWithDuplicates(52);
  for (std::size_t k = 24; k < graph.constraints.size(); ++k) graph.constraints[k].robust = true;
  NormalEquations<SE2> equations;
  equations.SetStructure(graph);
  const double F = equations.Linearize(graph, objective);
  EXPECT_DOUBLE_EQ(F, TotalError(graph, objective));
  constexpr double kStep = 1e-6;
  for (int node = 1; node < 25; ++node) {
    for (int k = 0; k < 3; ++k) {
      PoseGraph<SE2> moved = graph;
      SE2& pose = moved.poses[static_cast<std::size_t>(node)];
      const SE2 before = pose;
      pose = before.Boxplus(kStep * Eigen::Vector3d::Unit(k));
      const double above = TotalError(moved, objective);
      pose = before.Boxplus(-kStep * Eigen::Vector3d::Unit(k));
      const double slope = (above - TotalError(moved, objective)) / (2.0 * kStep);
      const double b = equations.gradient()[3 * equations.variable(node) + k];
      EXPECT_NEAR(0.5 * slope, b, 1e-5 * (std::abs(b) + 1.0)) << "node " << node;
    }
  }
}

TEST(NormalEquations, ErrorWithoutLossIsTotalChi2) {
  const PoseGraph<SE2> graph = test_support::RandomGraph(30, 20, 53);
  EXPECT_DOUBLE_EQ(TotalError(graph, {{LossKind::kHuber, 0.01}}), TotalChi2(graph));
}

TEST(NormalEquations, GrownGraphGivesWhatAFreshObjectGives) {
  const PoseGraph<SE2> whole = test_support::RandomGraph(30, 40, 54);
  PoseGraph<SE2> graph;
  NormalEquations<SE2> grown;
  for (std::size_t nodes = 1; nodes <= 30; ++nodes) {
    graph.poses.assign(whole.poses.begin(),
                       whole.poses.begin() + static_cast<std::ptrdiff_t>(nodes));
    for (const Constraint<SE2>& constraint : whole.constraints) {
      const auto newest = static_cast<std::size_t>(std::max(constraint.from, constraint.to));
      if (newest + 1 == nodes) graph.constraints.push_back(constraint);
    }
    EXPECT_EQ(grown.SetStructure(graph), nodes > 1);  // the first node is held: no variable
    EXPECT_FALSE(grown.SetStructure(graph)) << "nothing has changed";
    grown.Linearize(graph, {});
    EXPECT_TRUE(
        test_support::Dense(grown.hessian())
            .isApprox(Reduce(test_support::DenseHessian(graph), grown, static_cast<int>(nodes)),
                      1e-12));
  }
}

TEST(NormalEquations, OtherChangesOfTheGraphAreNoticed) {
  PoseGraph<SE2> graph = test_support::RandomGraph(12, 10, 55);
  const auto expect_right = [&graph](NormalEquations<SE2>* equations) {
    equations->SetStructure(graph);
    equations->Linearize(graph, {});
    EXPECT_TRUE(test_support::Dense(equations->hessian())
                    .isApprox(Reduce(test_support::DenseHessian(graph), *equations,
                                     static_cast<int>(graph.poses.size())),
                              1e-12));
  };
  NormalEquations<SE2> equations;
  expect_right(&equations);
  graph.constraints.erase(graph.constraints.begin() + 12);  // a closure taken out again
  expect_right(&equations);
  graph.constraints.back().to = graph.constraints.back().from == 0 ? 1 : 0;
  expect_right(&equations);
  graph.fixed = {5};
  expect_right(&equations);
  graph.constraints.pop_back();
  expect_right(&equations);
  graph.poses.emplace_back();  // a component of its own
  expect_right(&equations);
  EXPECT_EQ(equations.variable(12), -1);
  graph.constraints.push_back({11, 12, SE2(1, 0, 0), Eigen::Matrix3d::Identity()});
  expect_right(&equations);  // no longer
  EXPECT_NE(equations.variable(12), -1);
}

}  // namespace
}  // namespace loopgrid
