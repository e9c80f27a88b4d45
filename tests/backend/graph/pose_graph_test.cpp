#include "backend/graph/pose_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

PoseGraph<SE2> GraphWithEdges(int nodes, const std::vector<std::pair<int, int>>& edges) {
  PoseGraph<SE2> graph;
  graph.poses.resize(static_cast<std::size_t>(nodes));
  for (const auto& [from, to] : edges) {
    graph.constraints.emplace_back();
    graph.constraints.back().from = from;
    graph.constraints.back().to = to;
  }
  return graph;
}

TEST(ConnectedComponents, AreNamedByTheirFirstNode) {
  EXPECT_THAT(ConnectedComponents(GraphWithEdges(7, {{5, 1}, {4, 2}, {1, 3}, {3, 5}})).of_node,
              ElementsAre(0, 1, 2, 1, 2, 1, 6));
}

TEST(ConnectedComponents, OfAnEmptyGraphAreNone) {
  EXPECT_THAT(ConnectedComponents(PoseGraph<SE2>()).of_node, IsEmpty());
}

TEST(HeldNodes, AreTheFirstOfEachComponentWithoutAFixedNode) {
  PoseGraph<SE2> graph = GraphWithEdges(7, {{5, 1}, {4, 2}, {1, 3}, {3, 5}});
  EXPECT_THAT(HeldNodes(graph, ConnectedComponents(graph)), ElementsAre(0, 1, 2, 6));
  graph.fixed = {5, 3};
  EXPECT_THAT(HeldNodes(graph, ConnectedComponents(graph)), ElementsAre(0, 2, 3, 5, 6));
}

TEST(Validate, AcceptsEmptyGraphsLoneNodesAndDuplicateConstraints) {
  Validate(PoseGraph<SE2>());
  Validate(GraphWithEdges(1, {}));
  Validate(GraphWithEdges(3, {{0, 1}, {0, 1}, {1, 0}}));
}

TEST(Validate, AcceptsInformationThatIsOffByRounding) {
  PoseGraph<SE2> graph = GraphWithEdges(2, {{0, 1}});
  Eigen::Matrix3d& information = graph.constraints[0].information;
  information = Eigen::Vector3d(1e6, 1e6, -1e-5).asDiagonal();
  information(0, 1) = 1e-4;
  Validate(graph);
  information.setZero();
  Validate(graph);
}

TEST(Validate, NamesWhatIsWrong) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  struct Case {
    std::function<void(PoseGraph<SE2>*)> spoil;
    std::string message;
  };
  const std::vector<Case> cases = {
      {[&](PoseGraph<SE2>* g) { g->poses[2] = SE2(nan, 0, 0); }, "pose of node 2"},
      {[&](PoseGraph<SE2>* g) { g->poses[1] = SE2(0, 0, infinity); }, "pose of node 1"},
      {[&](PoseGraph<SE2>* g) { g->constraints[1].T_from_to = SE2(0, infinity, 0); },
       "constraint 1"},
      {[&](PoseGraph<SE2>* g) { g->constraints[0].information(2, 2) = nan; }, "constraint 0"},
      {[&](PoseGraph<SE2>* g) { g->constraints[0].to = 3; }, "constraint 0 refers to node 3"},
      {[&](PoseGraph<SE2>* g) { g->constraints[1].from = -1; }, "constraint 1 refers to node -1"},
      {[&](PoseGraph<SE2>* g) { g->constraints[1].from = 2; },
       "constraint 1 joins node 2 to itself"},
      {[&](PoseGraph<SE2>* g) {
         g->fixed = {0, 3};
       },
       "fixed node 1 refers to node 3"},
      {[&](PoseGraph<SE2>* g) { g->constraints[1].information(0, 2) = 0.25; },
       "the information matrix of constraint 1 from node 1 to node 2 is not symmetric: 0.25 at (0, "
       "2), 0 at (2, 0)"},
      {[&](PoseGraph<SE2>* g) { g->constraints[0].information(2, 2) = -3.0; },
       "the information matrix of constraint 0 from node 0 to node 1 is not positive "
       "semi-definite: its smallest eigenvalue is -3"},
      {[&](PoseGraph<SE2>* g) { g->observations[0].information(0, 1) = 1e-3; },
       "the information matrix of observation 0 of landmark 0 from node 2 is not symmetric: 0.001 "
       "at (0, 1), 0 at (1, 0)"},
      {[&](PoseGraph<SE2>* g) { g->observations[0].information << 1.0, 2.0, 2.0, 1.0; },
       "the information matrix of observation 0 of landmark 0 from node 2 is not positive "
       "semi-definite: its smallest eigenvalue is -1"},
      {[&](PoseGraph<SE2>* g) { g->observations[0].landmark = 1; },
       "observation 0 refers to landmark 1"},
  };
  for (const Case& c : cases) {
    PoseGraph<SE2> graph = GraphWithEdges(3, {{0, 1}, {1, 2}});
    graph.landmarks.emplace_back(1.0, 2.0);
    graph.observations.push_back({2, 0, Eigen::Vector2d(1.0, 2.0)});
    Validate(graph);
    c.spoil(&graph);
    try {
      Validate(graph);
      ADD_FAILURE() << "accepted: " << c.message;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInput);
      EXPECT_THAT(error.what(), HasSubstr(c.message));
    }
  }
}

TEST(DegreesOfFreedom, AreEquationsMinusUnknowns) {
  // Two components of a loop and a pair; one landmark seen three times, one never.
  PoseGraph<SE2> graph = GraphWithEdges(5, {{0, 1}, {1, 2}, {2, 0}, {3, 4}});
  EXPECT_EQ(DegreesOfFreedom(graph, ConnectedComponents(graph)), 3 * (4 - 3));
  graph.landmarks.resize(2);
  graph.observations.resize(3);
  EXPECT_EQ(DegreesOfFreedom(graph, ConnectedComponents(graph)), 3 * (4 - 3) + 2 * (3 - 1));
  graph.fixed = {0, 1};
  EXPECT_EQ(DegreesOfFreedom(graph, ConnectedComponents(graph)), 3 * (4 - 2) + 2 * (3 - 1));
}

}  // namespace
}  // namespace loopgrid
