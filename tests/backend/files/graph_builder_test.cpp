#include "backend/files/graph_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "backend/graph/constraint_error.h"
#include "tests/support/graph_texts.h"
#include "tests/support/graphs.h"
#include "tests/support/poses.h"

namespace loopgrid {
namespace {

using test_support::ExpectLinesRefused;
using test_support::ReadGraphText;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(GraphBuilder, WrongVerticesAreRefusedWithTheirLine) {
  ExpectLinesRefused("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 0 0\nVERTEX_XY 2 0 0\n",
                     {
                         {"VERTEX_SE2 1 5 5 5", "vertex 1 for the second time"},
                         {"VERTEX_SE2 2 5 5 5", "vertex 2 for the second time"},
                         {"VERTEX_XY 2 5 5", "vertex 2 for the second time"},
                         {"VERTEX_XY 1 5 5", "vertex 1 for the second time"},
                         {"EDGE_SE2 1 1 0 0 0 1 0 0 1 0 1", "joins vertex 1 to itself"},
                         {"EDGE_SE2 0 7 0 0 0 1 0 0 1 0 1", "vertex 7 is not in the file"},
                         {"EDGE_SE2 7 0 0 0 0 1 0 0 1 0 1", "vertex 7 is not in the file"},
                         {"EDGE_SE2 0 2 0 0 0 1 0 0 1 0 1", "2 is a landmark, expected a pose"},
                         {"EDGE_SE2_XY 0 1 0 0 1 0 1", "vertex 1 is a pose, expected a landmark"},
                         {"EDGE_SE2_XY 2 2 0 0 1 0 1", "2 is a landmark, expected a pose"},
                         {"EDGE_SE2_XY 0 8 0 0 1 0 1", "vertex 8 is not in the file"},
                         {"FIX 8", "vertex 8 is not in the file"},
                         {"FIX 0 2", "vertex 2 is a landmark, expected a pose"},
                     });
}

TEST(GraphBuilder, WhatAnEdgeNamesMayComeLater) {
  const auto read = ReadGraphText<SE2>(
      "EDGE_SE2 70 -5 1 2 0.5 1 0 0 1 0 1\nEDGE_SE2_XY 70 8 1 2 1 0 1\nFIX 70\n"
      "VERTEX_XY 8 0 0\nVERTEX_SE2 -5 0 0 0\nVERTEX_SE2 70 0 0 0\n");
  EXPECT_THAT(read.ids.nodes, ElementsAre(-5, 70));
  EXPECT_THAT(read.ids.landmarks, ElementsAre(8));
  EXPECT_THAT(read.graph.fixed, ElementsAre(1));
  ASSERT_EQ(read.graph.constraints.size(), 1U);
  EXPECT_EQ(read.graph.constraints[0].from, 1);
  EXPECT_EQ(read.graph.constraints[0].to, 0);
  ASSERT_EQ(read.graph.observations.size(), 1U);
  EXPECT_EQ(read.graph.observations[0].node, 1);
  EXPECT_EQ(read.graph.observations[0].landmark, 0);
}

TEST(GraphBuilder, FixedNodesAreAscendingAndNamedOnce) {
  const auto read = ReadGraphText<SE2>(
      "VERTEX_SE2 9 0 0 0\nFIX 4 9 4\nVERTEX_SE2 5 0 0 0\nVERTEX_SE2 4 0 0 0\nFIX 9\n");
  EXPECT_THAT(read.graph.fixed, ElementsAre(0, 2));
}

TEST(GraphBuilder, EdgesWithoutVerticesNumberTheirNodesByIdAndSaySo) {
  GraphNotes notes;
  const auto read = ReadGraphText<SE2>(
      "EDGE_SE2 20 -4 1 0 0.5 1 0 0 1 0 1\nEDGE_SE2 7 20 1 0 0.5 1 0 0 1 0 1\n"
      "EDGE_SE2_XY 20 3 0.5 0.9 1 0 1\nFIX 7\n",
      &notes);
  EXPECT_EQ(notes.guessed_nodes, 3);
  EXPECT_THAT(read.ids.nodes, ElementsAre(-4, 7, 20));
  EXPECT_THAT(read.ids.landmarks, ElementsAre(3));
  EXPECT_THAT(read.graph.fixed, ElementsAre(1));
  EXPECT_EQ(read.graph.poses[1].coordinates(), Eigen::Vector3d::Zero());
  EXPECT_NEAR(TotalChi2(read.graph), 0.0, 1e-20);
}

TEST(GraphBuilder, NoNodesAreGuessedWhereThereAreVertices) {
  GraphNotes notes;
  ReadGraphText<SE2>("VERTEX_SE2 0 0 0 0\n", &notes);
  EXPECT_EQ(notes.guessed_nodes, 0);
  EXPECT_THAT(test_support::Refusal("VERTEX_XY 3 0 0\nEDGE_SE2 0 1 0 0 0 1 0 0 1 0 1\n"),
              HasSubstr("2: vertex 0 is not in the file"));
}

TEST(GraphBuilder, RefusesAGuessBeyondTheRangeOfNumbers) {
  EXPECT_THAT(test_support::Refusal("EDGE_SE2 0 1 1e308 0 0 1 0 0 1 0 1\n"
                                    "EDGE_SE2 1 2 1e308 0 0 1 0 0 1 0 1\n"),
              HasSubstr("too long to be put together"));
}

TEST(GraphBuilder, LandmarksWithoutVerticesMustNotBeNodesToo) {
  EXPECT_THAT(test_support::Refusal("EDGE_SE2 0 1 0 0 0 1 0 0 1 0 1\nEDGE_SE2_XY 0 1 0 0 1 0 1\n"),
              HasSubstr("2: vertex 1 is a pose, expected a landmark"));
}

template <typename Pose>
class EdgesOnlyTest : public ::testing::Test {};
TYPED_TEST_SUITE(EdgesOnlyTest, test_support::AllPoses, test_support::PoseName);

TYPED_TEST(EdgesOnlyTest, BeginAtASpanningTree) {
  using Pose = TypeParam;
  auto graph = test_support::RandomGraph<Pose>(30, 0, 4, 5);  // no loops: the tree is all of it
  for (LandmarkObservation<Pose>& observation : graph.observations) {
    observation.p_node = graph.poses[static_cast<std::size_t>(observation.node)].Inverse() *
                         graph.landmarks[static_cast<std::size_t>(observation.landmark)];
  }
  std::string edges;
  std::string text = FormatGraph(graph);
  while (!text.empty()) {
    const std::string line = text.substr(0, text.find('\n') + 1);
    if (line.rfind("VERTEX", 0) != 0) edges += line;
    text.erase(0, line.size());
  }
  const auto read = ReadGraphText<Pose>(edges);
  ASSERT_EQ(read.graph.poses.size(), graph.poses.size());
  const Pose T_ours_theirs = graph.poses[0] * read.graph.poses[0].Inverse();
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    EXPECT_LT(test_support::Distance(T_ours_theirs * read.graph.poses[i], graph.poses[i]), 1e-9);
  }
  for (std::size_t i = 0; i < graph.landmarks.size(); ++i) {
    EXPECT_LT((T_ours_theirs * read.graph.landmarks[i] - graph.landmarks[i]).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace loopgrid
