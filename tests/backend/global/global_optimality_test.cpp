#include "backend/global/global_optimality.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "backend/base/error.h"
#include "backend/graph/constraint_error.h"
#include "backend/solve/optimizer.h"
#include "tests/support/noisy_graphs.h"
#include "tests/support/poses.h"

namespace loopgrid {
namespace {

using Kind = OptimalityCertificate::Kind;

template <typename Pose>
class GlobalOptimalityTest : public ::testing::Test {};
TYPED_TEST_SUITE(GlobalOptimalityTest, test_support::AllPoses, test_support::PoseName);

TYPED_TEST(GlobalOptimalityTest, AnExactGraphIsAtItsGlobalOptimum) {
  std::mt19937 random(1);
  const auto graph = test_support::RandomKnownGraph<TypeParam>(20, 15, 5, 0.0, &random);
  const OptimalityCertificate certificate = CertifyOptimality(graph);
  EXPECT_EQ(certificate.kind, Kind::kGlobal);
  EXPECT_NEAR(certificate.error, 0.0, 1e-20);
}

TYPED_TEST(GlobalOptimalityTest, TheOptimumOfANoisyGraphIsGlobal) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    std::mt19937 random(seed);
    auto graph = test_support::RandomKnownGraph<TypeParam>(30, 30, 5, 0.02, &random);
    if (seed % 2 == 1) graph.fixed = {2, 17};
    Optimizer<TypeParam>().Optimize(&graph);
    const OptimalityCertificate certificate = CertifyOptimality(graph);
    // Correlations leave a little open in 3D.
    const double open = TypeParam::kDof == 3 ? 1e-6 : 0.2;
    EXPECT_GE(certificate.lower_bound, (1.0 - open) * certificate.error) << "seed " << seed;
    EXPECT_LE(certificate.lower_bound, certificate.error) << "seed " << seed;
    EXPECT_NEAR(certificate.error, TotalChi2(graph), 1e-12 * certificate.error);
  }
}

/// The dual is an optimisation over more than rotations: whatever poses there are, its bound is
/// below them.
TYPED_TEST(GlobalOptimalityTest, NoStartEndsBelowTheBound) {
  int bounds = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const double noise = 0.1 * (seed % 10);
    auto graph = test_support::RandomKnownGraph<TypeParam>(5, 5, 2, noise, &random);
    Optimizer<TypeParam>().Optimize(&graph);
    const double bound = CertifyOptimality(graph).lower_bound;
    if (bound > 0.0) ++bounds;
    for (int trial = 0; trial < 20; ++trial) {
      test_support::Scramble(&graph, &random);
      Optimizer<TypeParam>().Optimize(&graph);
      EXPECT_GE(TotalChi2(graph), bound * (1.0 - 1e-6) - 1e-9) << "seed " << seed;
    }
  }
  EXPECT_GE(bounds, 15);
}

TYPED_TEST(GlobalOptimalityTest, ARingWoundOnceMoreIsNot) {
  auto graph = test_support::Ring<TypeParam>(30, 1);
  const OptimizerResult result = Optimizer<TypeParam>().Optimize(&graph);
  ASSERT_EQ(result.termination, Termination::kConverged);
  ASSERT_GT(result.final_error, 0.1) << "expected a local minimum";
  const OptimalityCertificate certificate = CertifyOptimality(graph);
  EXPECT_NE(certificate.kind, Kind::kGlobal);
  EXPECT_LE(certificate.lower_bound, 1e-9);

  auto straight = test_support::Ring<TypeParam>(30, 0);
  EXPECT_EQ(CertifyOptimality(straight).kind, Kind::kGlobal);
}

TYPED_TEST(GlobalOptimalityTest, APointNextToTheOptimumIsBoundedByIt) {
  std::mt19937 random(3);
  auto graph = test_support::RandomKnownGraph<TypeParam>(20, 30, 0, 0.02, &random);
  for (auto& constraint : graph.constraints) constraint.information.setIdentity();
  Optimizer<TypeParam>().Optimize(&graph);
  const double optimum = TotalChi2(graph);
  for (std::size_t i = 1; i < graph.poses.size(); ++i) {
    graph.poses[i] = graph.poses[i].Boxplus(TypeParam::Tangent::Constant(1e-3));
  }
  const OptimalityCertificate certificate = CertifyOptimality(graph);
  EXPECT_EQ(certificate.kind, Kind::kBounded);
  EXPECT_NEAR(certificate.lower_bound, optimum, 1e-6 * optimum);
  EXPECT_GT(certificate.error, 1.01 * optimum);
}

TYPED_TEST(GlobalOptimalityTest, ComponentsAreToldTogether) {
  std::mt19937 random(4);
  auto graph = test_support::Ring<TypeParam>(30, 0);
  auto wound = test_support::Ring<TypeParam>(30, 1);
  Optimizer<TypeParam>().Optimize(&wound);
  for (auto constraint : wound.constraints) {
    constraint.from += 30;
    constraint.to += 30;
    graph.constraints.push_back(constraint);
  }
  auto both = graph;
  both.poses.insert(both.poses.end(), graph.poses.begin(), graph.poses.begin() + 30);
  EXPECT_EQ(CertifyOptimality(both).kind, Kind::kGlobal);
  graph.poses.insert(graph.poses.end(), wound.poses.begin(), wound.poses.end());
  EXPECT_NE(CertifyOptimality(graph).kind, Kind::kGlobal);
}

TYPED_TEST(GlobalOptimalityTest, NothingToMoveIsGlobal) {
  PoseGraph<TypeParam> graph;
  EXPECT_EQ(CertifyOptimality(graph).kind, Kind::kGlobal);
  std::mt19937 random(5);
  graph = test_support::RandomKnownGraph<TypeParam>(2, 0, 0, 0.0, &random);
  graph.fixed = {0, 1};
  graph.poses[1] = TypeParam();
  const OptimalityCertificate certificate = CertifyOptimality(graph);
  EXPECT_GT(certificate.error, 0.0);
  EXPECT_EQ(certificate.kind, Kind::kGlobal);
}

TYPED_TEST(GlobalOptimalityTest, RefusesABrokenGraph) {
  PoseGraph<TypeParam> graph;
  graph.constraints.push_back({0, 1, TypeParam()});
  EXPECT_THROW(CertifyOptimality(graph), Error);
}

}  // namespace
}  // namespace loopgrid
