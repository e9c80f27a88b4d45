#include "frontend/closing/closure_graph.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <optional>
#include <random>
#include <vector>

#include "backend/solve/marginals.h"
#include "tests/support/graphs.h"
#include "tests/support/index.h"

namespace loopgrid {
namespace {

using test_support::Index;
using test_support::NoisyConstraint;
using test_support::RandomGraph;

// Closures with the ids 100, 101, ...
std::vector<ClosureConstraint> Numbered(const std::vector<Constraint<SE2>>& constraints) {
  std::vector<ClosureConstraint> closures;
  for (const Constraint<SE2>& c : constraints) {
    closures.push_back({100 + static_cast<ClosureId>(closures.size()), c});
  }
  return closures;
}

// Adds the nodes `from` to `to` - 1 of a chain, each at the measured pose from the one before.
void AddChain(const PoseGraph<SE2>& chain, int from, int to, ClosureGraph* graph) {
  for (int i = from; i < to; ++i) {
    if (i == 0) {
      graph->AddNode(chain.poses[0], SE2(), Eigen::Matrix3d::Zero());
      continue;
    }
    const Constraint<SE2>& step = chain.constraints[Index(i - 1)];
    const SE2& last = graph->graph().poses.back();
    graph->AddNode(last * step.T_from_to, step.T_from_to, step.information.inverse());
  }
}

// A closure that agrees with the chain, with a small noise of its own.
Constraint<SE2> TrueClosure(const PoseGraph<SE2>& chain, int from, int to, unsigned seed) {
  std::mt19937 random(seed);
  Constraint<SE2> closure = NoisyConstraint(chain.poses, from, to, &random);
  closure.robust = true;
  return closure;
}

Constraint<SE2> FalseClosure(const PoseGraph<SE2>& chain, int from, int to, unsigned seed) {
  Constraint<SE2> closure = TrueClosure(chain, from, to, seed);
  closure.T_from_to = closure.T_from_to * SE2(6.0, -8.0, 1.5);
  return closure;
}

// Chains whose steps are certain enough to contradict a wrong closure.
PoseGraph<SE2> Chain(int nodes, unsigned seed) {
  PoseGraph<SE2> chain = RandomGraph(nodes, 0, seed);
  for (Constraint<SE2>& step : chain.constraints) step.information *= 100.0;
  return chain;
}

void ExpectCovariancesAreTheBackends(const ClosureGraph& graph) {
  RobustLoss loss;
  loss.kind = LossKind::kHuber;
  const std::optional<std::vector<Eigen::Matrix3d>> expected =
      RelativeCovariances(graph.graph(), graph.size() - 1, loss);
  ASSERT_TRUE(expected);
  ASSERT_EQ(graph.relative_covariances().size(), expected->size());
  for (std::size_t i = 0; i < expected->size(); ++i) {
    const Eigen::Matrix3d& covariance = graph.relative_covariances()[i];
    EXPECT_LE((covariance - (*expected)[i]).norm(), 1e-9 * (*expected)[i].norm()) << i;
  }
}

void ExpectSamePoses(const std::vector<SE2>& a, const std::vector<SE2>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].coordinates(), b[i].coordinates());
}

TEST(ClosureGraph, TheFirstNodeTakesNoConstraint) {
  ClosureGraph graph;
  EXPECT_EQ(graph.size(), 0);
  graph.AddNode(SE2(1.0, 2.0, 3.0), SE2(), Eigen::Matrix3d::Zero());
  EXPECT_EQ(graph.size(), 1);
  EXPECT_TRUE(graph.graph().constraints.empty());
  EXPECT_TRUE(graph.relative_covariances().at(0).isZero(0.0));
}

TEST(ClosureGraph, CovariancesAreTheBackendsAlongChainsAndClosures) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const PoseGraph<SE2> chain = Chain(60, seed);
    ClosureGraph graph;
    AddChain(chain, 0, 20, &graph);
    ExpectCovariancesAreTheBackends(graph);
    ASSERT_TRUE(graph.TryClosures(Numbered({TrueClosure(chain, 2, 19, seed)})));
    ExpectCovariancesAreTheBackends(graph);
    AddChain(chain, 20, 45, &graph);
    ExpectCovariancesAreTheBackends(graph);
    ASSERT_TRUE(graph.TryClosures(
        Numbered({TrueClosure(chain, 5, 44, seed), TrueClosure(chain, 40, 7, seed + 9)})));
    ExpectCovariancesAreTheBackends(graph);
    EXPECT_FALSE(graph.TryClosures(Numbered({FalseClosure(chain, 1, 43, seed)})));
    ExpectCovariancesAreTheBackends(graph);
    AddChain(chain, 45, 60, &graph);
    ExpectCovariancesAreTheBackends(graph);
    graph.Settle(Numbered({TrueClosure(chain, 10, 59, seed)}));
    ExpectCovariancesAreTheBackends(graph);
  }
}

TEST(ClosureGraph, KeepsARightClosureAndGoesByIt) {
  const PoseGraph<SE2> chain = Chain(30, 11);
  ClosureGraph graph;
  AddChain(chain, 0, 30, &graph);
  Constraint<SE2> closure = TrueClosure(chain, 3, 28, 11);
  closure.T_from_to = closure.T_from_to * SE2(0.02, -0.01, 0.005);
  const double before = graph.Chi2(closure);
  ASSERT_TRUE(graph.TryClosures(Numbered({closure})));
  EXPECT_EQ(graph.graph().constraints.size(), 30U);
  EXPECT_LT(graph.Chi2(closure), 0.9 * before);
  EXPECT_LE(graph.Chi2(closure), ClosureGraphOptions().max_chi2);
}

TEST(ClosureGraph, LeavesOutAWrongClosureAndReturnsExactly) {
  for (unsigned seed = 20; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    const PoseGraph<SE2> chain = Chain(40, seed);
    ClosureGraph graph;
    AddChain(chain, 0, 40, &graph);
    ASSERT_TRUE(graph.TryClosures(Numbered({TrueClosure(chain, 4, 35, seed)})));
    const PoseGraph<SE2> before = graph.graph();
    EXPECT_FALSE(graph.TryClosures(Numbered({FalseClosure(chain, 2, 39, seed)})));
    ExpectSamePoses(graph.graph().poses, before.poses);
    EXPECT_EQ(graph.graph().constraints.size(), before.constraints.size());
    // No other closure was removed with it.
    EXPECT_TRUE(graph.TryClosures(Numbered({TrueClosure(chain, 6, 37, seed + 2)})));
    EXPECT_EQ(graph.graph().constraints.size(), before.constraints.size() + 1);
  }
}

TEST(ClosureGraph, OfThreeRightAndAWrongClosureKeepsTheRightOnes) {
  for (unsigned seed = 20; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    const PoseGraph<SE2> chain = Chain(40, seed);
    ClosureGraph graph;
    AddChain(chain, 0, 40, &graph);
    std::vector<ClosureId> removed;
    const std::vector<Constraint<SE2>> closures = {
        TrueClosure(chain, 5, 36, seed), FalseClosure(chain, 2, 39, seed),
        TrueClosure(chain, 7, 34, seed), TrueClosure(chain, 3, 37, seed)};
    ASSERT_TRUE(graph.TryClosures(Numbered(closures), &removed));
    ASSERT_EQ(removed.size(), 1U);
    EXPECT_EQ(removed[0], 101);
    EXPECT_EQ(graph.graph().constraints.size(), 39U + 3U);
    ExpectCovariancesAreTheBackends(graph);
  }
}

TEST(ClosureGraph, AWrongClosureGivesWayToTheRightOnesThatComeLater) {
  const PoseGraph<SE2> chain = Chain(40, 31);
  ClosureGraph graph;
  // Nothing contradicts it yet, because its part of the chain is uncertain.
  AddChain(chain, 0, 40, &graph);
  Constraint<SE2> wrong = TrueClosure(chain, 3, 30, 31);
  wrong.T_from_to = wrong.T_from_to * SE2(0.6, 0.4, 0.1);
  constexpr ClosureId kWrong = 7;
  ASSERT_TRUE(graph.TryClosures(std::vector{ClosureConstraint{kWrong, wrong}}));
  std::vector<Constraint<SE2>> right;
  for (int i = 0; i < 4; ++i) {
    right.push_back(TrueClosure(chain, i + 1, 29 + i, 31));
    right.back().information *= 100.0;
  }
  std::vector<ClosureId> removed;
  ASSERT_TRUE(graph.TryClosures(Numbered(right), &removed));
  ASSERT_EQ(removed.size(), 1U);
  EXPECT_EQ(removed[0], kWrong);
  EXPECT_EQ(graph.graph().constraints.size(), 39U + 4U);
  ExpectCovariancesAreTheBackends(graph);
}

TEST(ClosureGraph, SettleTakesOutThePlantedOutlierAmongGoodLinks) {
  for (unsigned seed = 30; seed < 36; ++seed) {
    SCOPED_TRACE(seed);
    const PoseGraph<SE2> chain = Chain(50, seed);
    ClosureGraph graph;
    AddChain(chain, 0, 50, &graph);
    std::vector<Constraint<SE2>> links;
    for (int i = 0; i < 20; ++i) links.push_back(TrueClosure(chain, i, 49 - i, seed));
    links[7] = FalseClosure(chain, 7, 42, seed);
    const std::vector<ClosureId> removed = graph.Settle(Numbered(links));
    EXPECT_EQ(std::count(removed.begin(), removed.end(), 107), 1);
    for (const ClosureConstraint& kept : graph.Closures()) {
      EXPECT_EQ(std::count(removed.begin(), removed.end(), kept.id), 0);
      EXPECT_EQ(kept.constraint.from, kept.id - 100);  // ids stay with their constraints
    }
    EXPECT_LE(removed.size(), 5U);  // some that it has pulled off may be removed too
    EXPECT_EQ(graph.graph().constraints.size(), 49U + 20U - removed.size());
    for (int i = 0; i < 50; ++i) {
      EXPECT_LT(graph.graph().poses[Index(i)].Boxminus(chain.poses[Index(i)]).norm(), 0.3) << i;
    }
  }
}

TEST(ClosureGraph, SettlesWithoutLinksClosuresOrNodes) {
  ClosureGraph empty;
  EXPECT_TRUE(empty.Settle({}).empty());
  EXPECT_EQ(empty.size(), 0);
  ClosureGraph one;
  one.AddNode(SE2(), SE2(), Eigen::Matrix3d::Zero());
  EXPECT_TRUE(one.Settle({}).empty());
  EXPECT_TRUE(one.relative_covariances().at(0).isZero(0.0));
  const PoseGraph<SE2> chain = Chain(10, 40);
  ClosureGraph graph;
  AddChain(chain, 0, 10, &graph);
  const std::vector<SE2> before = graph.graph().poses;
  EXPECT_TRUE(graph.Settle({}).empty());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_LT(graph.graph().poses[i].Boxminus(before[i]).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace loopgrid
