#include "backend/solve/normal_equations.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

#include "backend/graph/constraint_error.h"
#include "tests/support/block_matrices.h"
#include "tests/support/graphs.h"

namespace loopgrid {
namespace {

using test_support::AppendNextNode;
using test_support::RandomGraph;

template <typename Pose>
class NormalEquationsTest : public ::testing::Test {
 protected:
  static constexpr int kDof = Pose::kDof;
  static constexpr int kPoint = Pose::Point::RowsAtCompileTime;

  /// Nodes, landmarks, duplicate edges in both directions; everything but the sequence may be
  /// wrong, and half of it is.
  static PoseGraph<Pose> GraphOfAllKinds(unsigned seed) {
    PoseGraph<Pose> graph = RandomGraph<Pose>(20, 15, seed, 9);
    graph.constraints.push_back(graph.constraints[3]);
    graph.constraints.push_back(graph.constraints[20]);
    std::swap(graph.constraints.back().from, graph.constraints.back().to);
    for (std::size_t k = 19; k < graph.constraints.size(); ++k) graph.constraints[k].robust = true;
    for (std::size_t k = 0; k < graph.observations.size(); k += 2) {
      graph.observations[k].robust = true;
    }
    return graph;
  }

  /// Where in the equations each row of DenseNormalEquations is found, -1 for what is held.
  static std::vector<int> RowsOfVariables(const PoseGraph<Pose>& graph,
                                          const NormalEquations<Pose>& equations) {
    std::vector<int> rows;
    const auto append = [&rows](int variable, int count) {
      for (int k = 0; k < count; ++k) rows.push_back(variable < 0 ? -1 : kDof * variable + k);
    };
    for (int i = 0; i < static_cast<int>(graph.poses.size()); ++i) {
      append(equations.variable(i), kDof);
    }
    for (int i = 0; i < static_cast<int>(graph.landmarks.size()); ++i) {
      append(equations.landmark_variable(i), kPoint);
    }
    return rows;
  }

  /// Compares with the dense sums: rows of landmarks that these do not have are those of the unit
  /// matrix.
  static void ExpectRight(const PoseGraph<Pose>& graph, const NormalEquations<Pose>& equations,
                          const Objective& objective) {
    const auto size = static_cast<Eigen::Index>(kDof) * equations.variable_count();
    test_support::DenseEquations expected{Eigen::MatrixXd::Identity(size, size),
                                          Eigen::VectorXd::Zero(size)};
    const auto sums = test_support::DenseNormalEquations(graph, objective);
    const std::vector<int> rows = RowsOfVariables(graph, equations);
    ASSERT_EQ(static_cast<Eigen::Index>(rows.size()), sums.b.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i] < 0) continue;
      expected.b(rows[i]) = sums.b(static_cast<Eigen::Index>(i));
      for (std::size_t j = 0; j < rows.size(); ++j) {
        if (rows[j] < 0) continue;
        expected.H(rows[i], rows[j]) =
            sums.H(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      }
    }
    EXPECT_TRUE(test_support::Dense(equations.hessian()).isApprox(expected.H, 1e-12));
    EXPECT_TRUE(equations.gradient().isApprox(expected.b, 1e-12));
  }
};

TYPED_TEST_SUITE(NormalEquationsTest, test_support::AllPoses, test_support::PoseName);

TYPED_TEST(NormalEquationsTest, AreTheSumsOverAllEdgesWithoutTheHeldNodes) {
  PoseGraph<TypeParam> graph = this->GraphOfAllKinds(51);
  for (const std::vector<int>& fixed : {std::vector<int>{}, std::vector<int>{4, 19}}) {
    graph.fixed = fixed;
    NormalEquations<TypeParam> equations;
    EXPECT_TRUE(equations.SetStructure(graph));
    equations.Linearize(graph, {});
    EXPECT_EQ(equations.variable_count(), 20 + 9 - (fixed.empty() ? 1 : 2));
    this->ExpectRight(graph, equations, {});
  }
}

TYPED_TEST(NormalEquationsTest, WeighRobustEdgesByEveryLossInEveryParametrization) {
  const PoseGraph<TypeParam> graph = this->GraphOfAllKinds(52);
  NormalEquations<TypeParam> equations;
  equations.SetStructure(graph);
  for (const LossKind kind : {LossKind::kQuadratic, LossKind::kHuber, LossKind::kCauchy,
                              LossKind::kGemanMcClure, LossKind::kDcs}) {
    for (const Parametrization parametrization :
         {Parametrization::kManifold, Parametrization::kExponential, Parametrization::kEuler}) {
      const Objective objective{{kind, 0.5}, parametrization};
      const double F = equations.Linearize(graph, objective);
      EXPECT_NEAR(F, TotalError(graph, objective), 1e-12 * F);
      this->ExpectRight(graph, equations, objective);
    }
  }
}

TYPED_TEST(NormalEquationsTest, GradientIsTheDerivativeOfHalfF) {
  using Pose = TypeParam;
  const PoseGraph<Pose> graph = this->GraphOfAllKinds(53);
  const Objective objective{{LossKind::kCauchy, 1.0}};
  NormalEquations<Pose> equations;
  equations.SetStructure(graph);
  equations.Linearize(graph, objective);
  const std::vector<int> rows = this->RowsOfVariables(graph, equations);
  constexpr double kStep = 1e-6;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] < 0) continue;
    const auto error_after = [&](double step) {
      PoseGraph<Pose> moved = graph;
      const std::size_t in_nodes = Pose::kDof * graph.poses.size();
      if (i < in_nodes) {
        Pose& pose = moved.poses[i / Pose::kDof];
        pose = pose.Boxplus(step * Pose::Tangent::Unit(static_cast<int>(i % Pose::kDof)));
      } else {
        constexpr std::size_t kSize = Pose::Point::RowsAtCompileTime;
        moved.landmarks[(i - in_nodes) / kSize](static_cast<int>((i - in_nodes) % kSize)) += step;
      }
      return TotalError(moved, objective);
    };
    const double half_slope = (error_after(kStep) - error_after(-kStep)) / (4.0 * kStep);
    const double b = equations.gradient()(rows[i]);
    EXPECT_NEAR(half_slope, b, 1e-5 * (std::abs(b) + 1.0)) << "row " << i;
  }
}

TYPED_TEST(NormalEquationsTest, EdgesNotMarkedRobustStayQuadratic) {
  const auto graph = RandomGraph<TypeParam>(30, 20, 54, 5);
  EXPECT_DOUBLE_EQ(TotalError(graph, {{LossKind::kHuber, 0.01}}), TotalChi2(graph));
}

TYPED_TEST(NormalEquationsTest, HaveTheSameBitsForAnyNumberOfWorkers) {
  PoseGraph<TypeParam> graph = RandomGraph<TypeParam>(3000, 2500, 55, 2000);
  ASSERT_GT(graph.observations.size(), 4096u);  // enough to be shared out among some, or all
  for (std::size_t k = 0; k < graph.constraints.size(); k += 3) graph.constraints[k].robust = true;
  const Objective objective{{LossKind::kHuber, 0.3}};
  NormalEquations<TypeParam> expected;
  expected.SetStructure(graph);
  const double F = expected.Linearize(graph, objective);
  for (int threads : {1, 2, 3, 8}) {
    WorkerPool workers(threads);
    NormalEquations<TypeParam> equations;
    equations.SetStructure(graph);
    for (int round = 0; round < 2; ++round) {
      EXPECT_EQ(equations.Linearize(graph, objective, &workers), F) << threads << " threads";
      EXPECT_EQ(equations.gradient(), expected.gradient()) << threads << " threads";
      bool same = true;
      for (int i = 0; i < expected.variable_count(); ++i) {
        same = same && equations.hessian().diagonal(i) == expected.hessian().diagonal(i);
      }
      for (int k = 0; k < expected.hessian().block_count(); ++k) {
        same = same && equations.hessian().off_diagonal(k) == expected.hessian().off_diagonal(k);
      }
      EXPECT_TRUE(same) << threads << " threads";
    }
  }
}

TYPED_TEST(NormalEquationsTest, OfAGrownGraphAreThoseOfAFreshObject) {
  const auto whole = RandomGraph<TypeParam>(30, 40, 56, 12);
  PoseGraph<TypeParam> graph;
  NormalEquations<TypeParam> grown;
  while (graph.poses.size() < whole.poses.size()) {
    SCOPED_TRACE(graph.poses.size());
    AppendNextNode(whole, &graph);
    grown.SetStructure(graph);
    EXPECT_FALSE(grown.SetStructure(graph)) << "nothing has changed";
    grown.Linearize(graph, {});
    this->ExpectRight(graph, grown, {});
  }
  EXPECT_EQ(grown.variable_count(), 29 + 12);
}

TYPED_TEST(NormalEquationsTest, ALandmarkBecomesAVariableWhenItIsSeen) {
  PoseGraph<TypeParam> graph = RandomGraph<TypeParam>(5, 0, 57, 3);
  const std::vector<LandmarkObservation<TypeParam>> observations = graph.observations;
  graph.observations.clear();
  NormalEquations<TypeParam> equations;
  equations.SetStructure(graph);
  EXPECT_EQ(equations.landmark_count(), 3);
  EXPECT_EQ(equations.landmark_variable(1), -1);
  for (const auto& observation : observations) {
    graph.observations.push_back(observation);
    equations.SetStructure(graph);
    equations.Linearize(graph, {});
    EXPECT_GE(equations.landmark_variable(observation.landmark), 0);
    this->ExpectRight(graph, equations, {});
  }
}

TYPED_TEST(NormalEquationsTest, NoticeOtherChangesOfTheGraph) {
  PoseGraph<TypeParam> graph = RandomGraph<TypeParam>(12, 10, 58, 4);
  NormalEquations<TypeParam> equations;
  const auto expect_right = [&] {
    equations.SetStructure(graph);
    equations.Linearize(graph, {});
    this->ExpectRight(graph, equations, {});
  };
  expect_right();
  graph.constraints.erase(graph.constraints.begin() + 12);  // a closure taken out again
  expect_right();
  graph.constraints.back().to = graph.constraints.back().from == 0 ? 1 : 0;
  expect_right();
  graph.observations[2].landmark = 0;
  expect_right();
  graph.observations[2].node = graph.observations[2].node == 0 ? 1 : 0;
  expect_right();
  graph.fixed = {5};
  expect_right();
  graph.constraints.pop_back();
  expect_right();
  graph.observations.resize(1);  // the other landmarks are lost from sight
  expect_right();
  EXPECT_EQ(equations.landmark_variable(3), -1);
  graph.poses.emplace_back();  // a component of its own
  expect_right();
  EXPECT_EQ(equations.variable(12), -1);
  graph.constraints.push_back({11, 12, {}, Constraint<TypeParam>::Information::Identity()});
  expect_right();  // no longer
  EXPECT_NE(equations.variable(12), -1);
  graph.landmarks.resize(1);
  expect_right();
}

}  // namespace
}  // namespace loopgrid
