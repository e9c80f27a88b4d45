#include "backend/initial_guess.h"

#include <gtest/gtest.h>

#include "backend/constraint_error.h"
#include "tests/support/graphs.h"

namespace loopgrid {
namespace {

TEST(InitialGuess, ExactGraphsAreRecovered) {
  for (unsigned seed = 1; seed < 5; ++seed) {
    PoseGraph<SE2> graph = test_support::RandomGraph(40, 30, seed);
    for (Constraint<SE2>& c : graph.constraints) {
      c.T_from_to = graph.poses[static_cast<std::size_t>(c.from)].Inverse() *
                    graph.poses[static_cast<std::size_t>(c.to)];
    }
    PoseGraph<SE2> tree = graph;
    for (std::size_t i = 1; i < tree.poses.size(); ++i) tree.poses[i] = SE2();
    PoseGraph<SE2> chordal = tree;
    SetSpanningTreeGuess(&tree);
    EXPECT_NEAR(TotalChi2(tree), 0.0, 1e-16);
    ASSERT_TRUE(SetChordalGuess(&chordal));
    EXPECT_NEAR(TotalChi2(chordal), 0.0, 1e-16);
  }
}

}  // namespace
}  // namespace loopgrid
