#include "backend/global/best_start.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <string>
#include <variant>

#include "backend/files/graph_file.h"
#include "backend/graph/constraint_error.h"
#include "tests/support/noisy_graphs.h"
#include "tests/support/poses.h"

namespace loopgrid {
namespace {

using StartKind = OptimalityCertificate::Kind;

template <typename Pose>
class BestStartTest : public ::testing::Test {};
TYPED_TEST_SUITE(BestStartTest, test_support::AllPoses, test_support::PoseName);

TYPED_TEST(BestStartTest, AGoodStartIsTheOnlyOne) {
  std::mt19937 random(1);
  auto graph = test_support::RandomKnownGraph<TypeParam>(30, 20, 5, 0.01, &random);
  for (auto& constraint : graph.constraints) constraint.information.setIdentity();
  Optimizer<TypeParam> optimizer;
  const BestStartResult result = OptimizeFromBestStart(&graph, &optimizer);
  ASSERT_EQ(result.trials.size(), 1u);
  EXPECT_EQ(result.trials[0].start, InitialGuess::kNone);
  EXPECT_EQ(result.certificate->kind, StartKind::kGlobal);
  EXPECT_EQ(result.trials[0].result.final_error, TotalChi2(graph));
}

TYPED_TEST(BestStartTest, AHopelessStartIsReplaced) {
  std::mt19937 random(2);
  auto graph = test_support::RandomKnownGraph<TypeParam>(30, 30, 5, 0.01, &random);
  for (auto& constraint : graph.constraints) constraint.information *= 1e4;
  auto expected = graph;
  Optimizer<TypeParam>().Optimize(&expected);
  test_support::Scramble(&graph, &random);
  Optimizer<TypeParam> optimizer;
  const BestStartResult result = OptimizeFromBestStart(&graph, &optimizer);
  EXPECT_EQ(result.trials[0].start, InitialGuess::kChordal);
  EXPECT_NEAR(TotalChi2(graph), TotalChi2(expected), 1e-6 * TotalChi2(expected));
  EXPECT_EQ(result.trials[result.best].result.final_error, TotalChi2(graph));
}

TYPED_TEST(BestStartTest, ALocalMinimumIsLeft) {
  auto graph = test_support::Ring<TypeParam>(30, 1);
  for (auto& constraint : graph.constraints) constraint.information *= 1e-3;
  Optimizer<TypeParam> optimizer;
  optimizer.Optimize(&graph);
  const double stuck = TotalChi2(graph);
  ASSERT_GT(stuck, 1e-4);
  const BestStartResult result = OptimizeFromBestStart(&graph, &optimizer);
  ASSERT_EQ(result.trials.size(), 2u) << "F is as expected there, but it is not the optimum";
  EXPECT_EQ(result.trials[0].start, InitialGuess::kNone);
  EXPECT_EQ(result.best, 1u);
  EXPECT_NEAR(TotalChi2(graph), 0.0, 1e-12);
}

TYPED_TEST(BestStartTest, TheLowestEndIsKeptWhereNoneIsCertain) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    auto graph = test_support::RandomKnownGraph<TypeParam>(12, 20, 0, 1.0, &random);
    test_support::Scramble(&graph, &random);
    Optimizer<TypeParam> optimizer;
    const BestStartResult result = OptimizeFromBestStart(&graph, &optimizer);
    if (result.certificate->kind != StartKind::kGlobal) {
      EXPECT_EQ(result.trials.size(), 3u);
    }
    for (const StartTrial& trial : result.trials) {
      EXPECT_GE(trial.result.final_error, TotalChi2(graph)) << "seed " << seed;
    }
    EXPECT_EQ(result.trials[result.best].result.final_error, TotalChi2(graph));
    EXPECT_EQ(result.certificate->error, TotalChi2(graph));
  }
}

TYPED_TEST(BestStartTest, NoStartIsTriedTwice) {
  // All closures are wrong, so that no end is as low as expected. The poses are those of the chain,
  // up to six digits, and so are those of a spanning tree and of a chordal guess, which hardly
  // counts closures.
  std::mt19937 random(6);
  auto graph = test_support::RandomKnownGraph<TypeParam>(20, 12, 0, 0.0, &random);
  for (std::size_t k = 0; k < graph.constraints.size(); ++k) {
    Constraint<TypeParam>& constraint = graph.constraints[k];
    constraint.robust = k >= 19;
    if (constraint.robust) {
      constraint.T_from_to = test_support::RandomPose<TypeParam>(&random, 5.0);
    } else {
      constraint.information *= 1e3;
    }
  }
  for (std::size_t node = 1; node < graph.poses.size(); ++node) {
    const auto digits = test_support::RandomVector<typename TypeParam::Tangent>(&random, 1e-6);
    graph.poses[node] = graph.poses[node].Boxplus(digits);
  }
  OptimizerOptions options;
  options.loss = {LossKind::kGemanMcClure, 30.0};
  Optimizer<TypeParam> optimizer(options);
  const BestStartResult result = OptimizeFromBestStart(&graph, &optimizer);
  ASSERT_EQ(result.trials.size(), 1u);
  const auto expected = static_cast<double>(DegreesOfFreedom(graph, ConnectedComponents(graph)));
  EXPECT_GT(result.trials[0].result.final_error, expected) << "else one start would do anyway";
}

TYPED_TEST(BestStartTest, RobustLossesHaveNoCertificate) {
  std::mt19937 random(3);
  auto graph = test_support::RandomKnownGraph<TypeParam>(20, 10, 0, 0.01, &random);
  graph.constraints.back().robust = true;
  graph.constraints.back().T_from_to = test_support::RandomPose<TypeParam>(&random, 50.0);
  OptimizerOptions options;
  options.loss = {LossKind::kCauchy, 1.0};
  Optimizer<TypeParam> optimizer(options);
  const BestStartResult result = OptimizeFromBestStart(&graph, &optimizer);
  EXPECT_FALSE(result.certificate.has_value());
  EXPECT_EQ(result.trials.size(), 1u);
}

TYPED_TEST(BestStartTest, AStartThatIsAskedForIsTaken) {
  std::mt19937 random(4);
  const auto graph = test_support::RandomKnownGraph<TypeParam>(20, 10, 2, 0.05, &random);
  for (InitialGuess start :
       {InitialGuess::kNone, InitialGuess::kSpanningTree, InitialGuess::kChordal}) {
    auto moved = graph;
    test_support::Scramble(&moved, &random);
    Optimizer<TypeParam> optimizer;
    const BestStartResult result = OptimizeFromBestStart(&moved, &optimizer, start);
    ASSERT_EQ(result.trials.size(), 1u);
    EXPECT_EQ(result.trials[0].start, start) << ToString(start);
    EXPECT_EQ(result.trials[0].result.final_error, TotalChi2(moved));
  }
}

TYPED_TEST(BestStartTest, ATreeReplacesAChordalGuessThatDoesNotExist) {
  std::mt19937 random(5);
  auto graph = test_support::RandomKnownGraph<TypeParam>(6, 0, 0, 0.05, &random);
  graph.constraints.back().information.setZero();
  Optimizer<TypeParam> optimizer;
  const auto result = OptimizeFromBestStart(&graph, &optimizer, InitialGuess::kChordal);
  EXPECT_EQ(result.trials[0].start, InitialGuess::kSpanningTree);
}

struct SharedGraph {
  const char* file;
  double error;
};

/// Public benchmark graphs, which the project does not contain: LOOPGRID_DATA names the folder that
/// has them in graphs/.
class SharedGraphTest : public ::testing::TestWithParam<SharedGraph> {};

TEST_P(SharedGraphTest, ReachesTheGlobalOptimumFromTheStartInTheFile) {
  const char* folder = std::getenv("LOOPGRID_DATA");
  if (folder == nullptr) GTEST_SKIP() << "LOOPGRID_DATA is not set";
  AnyGraphFile file = ReadGraph(std::string(folder) + "/graphs/" + GetParam().file);
  std::visit(
      []<typename Pose>(GraphFile<Pose>& of_pose) {
        Optimizer<Pose> optimizer;
        const BestStartResult result = OptimizeFromBestStart(&of_pose.graph, &optimizer);
        EXPECT_LE(TotalChi2(of_pose.graph), GetParam().error * (1.0 + 1e-6));
        EXPECT_EQ(result.certificate->kind, StartKind::kGlobal);
        EXPECT_GE(result.certificate->lower_bound, GetParam().error * (1.0 - 1e-6));
        EXPECT_EQ(result.trials.size(), 1u);
      },
      file);
}

// Values of others, and this project's own where they are lower, or certified against others.
INSTANTIATE_TEST_SUITE_P(
    Graphs, SharedGraphTest,
    ::testing::Values(
        SharedGraph{"intel.g2o", 45.004696}, SharedGraph{"intel-hard-start.g2o", 215.830235},
        SharedGraph{"intel-943.g2o", 546.461112}, SharedGraph{"mitb-hard-start.g2o", 41.163269},
        SharedGraph{"fr079.graph", 37.599116}, SharedGraph{"manhattan3500.g2o", 146.076613},
        SharedGraph{"m3500-hard-start.g2o", 137.912951}, SharedGraph{"city10000.g2o", 511.985164},
        SharedGraph{"sphere2500.g2o", 727.149472}, SharedGraph{"sphere-mednoise.graph", 395.006212},
        SharedGraph{"sphere-bignoise.graph", 882010.07},
        SharedGraph{"sphere-bignoise.g2o", 743862.72}, SharedGraph{"torus3D.g2o", 14574.746187},
        SharedGraph{"parking-garage.g2o", 1.2386906}, SharedGraph{"smallGrid3D.g2o", 458.153787}),
    [](const auto& test) {
      std::string name = test.param.file;
      std::replace_if(
          name.begin(), name.end(), [](char c) { return c == '-' || c == '.'; }, '_');
      return name;
    });

}  // namespace
}  // namespace loopgrid
