#include "backend/graph_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "backend/base/error.h"
#include "tests/support/graphs.h"
#include "tests/support/memory_file.h"

namespace loopgrid {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

GraphFile<SE2> ReadText(const std::string& text) {
  return ReadGraphOf<SE2>(test_support::MemoryFile(text).path());
}

TEST(GraphFile, ReadsVerticesEdgesAndFixInAnyOrder) {
  const GraphFile<SE2> read = ReadText(
      "# a comment\n"
      "EDGE_SE2 70 -5 1 2 0.5 11 12 13 22 23 33000\n"
      "VERTEX_SE2 9000000000 1.5 -2.5 0.25\r\n"
      "\n"
      "FIX 70 -5\n"
      "VERTEX_SE2 -5 0 0 0\n"
      "FIX 70\n"
      "\tVERTEX_SE2  70   +1e1 .5 -3.5 ");
  EXPECT_THAT(read.ids.nodes, ElementsAre(9000000000, -5, 70));
  EXPECT_THAT(read.graph.fixed, ElementsAre(1, 2));
  ASSERT_EQ(read.graph.poses.size(), 3u);
  EXPECT_EQ(read.graph.poses[0].coordinates(), Eigen::Vector3d(1.5, -2.5, 0.25));
  EXPECT_EQ(read.graph.poses[2].coordinates(), Eigen::Vector3d(10.0, 0.5, NormalizeAngle(-3.5)));
  ASSERT_EQ(read.graph.constraints.size(), 1u);
  const Constraint<SE2>& constraint = read.graph.constraints[0];
  EXPECT_EQ(constraint.from, 2);
  EXPECT_EQ(constraint.to, 1);
  EXPECT_EQ(constraint.T_from_to.coordinates(), Eigen::Vector3d(1.0, 2.0, 0.5));
  const Eigen::Matrix3d expected =
      (Eigen::Matrix3d() << 11, 12, 13, 12, 22, 23, 13, 23, 33000).finished();
  EXPECT_EQ(constraint.information, expected);
}

TEST(GraphFile, RoundTripsLoseNothing) {
  GraphFile<SE2> graph;
  graph.graph = test_support::RandomGraph(60, 40, 5);
  graph.graph.poses[7] = SE2(1e-300, 123456789.123456789, -std::numbers::pi);
  graph.graph.fixed = {3, 59};
  for (int i = 0; i < 60; ++i) graph.ids.nodes.push_back(1000000007LL * (i - 30));
  graph.ids.nodes[59] = std::numeric_limits<std::int64_t>::min();

  const std::string folder = ::testing::TempDir();
  WriteGraph(folder + "round_trip.g2o", graph.graph, graph.ids);
  const GraphFile<SE2> again = ReadGraphOf<SE2>(folder + "round_trip.g2o");
  EXPECT_EQ(again.ids.nodes, graph.ids.nodes);
  EXPECT_EQ(again.graph.fixed, graph.graph.fixed);
  for (std::size_t i = 0; i < graph.graph.poses.size(); ++i) {
    EXPECT_EQ(again.graph.poses[i].coordinates(), graph.graph.poses[i].coordinates());
  }
  ASSERT_EQ(again.graph.constraints.size(), graph.graph.constraints.size());
  for (std::size_t k = 0; k < graph.graph.constraints.size(); ++k) {
    const Constraint<SE2>& before = graph.graph.constraints[k];
    const Constraint<SE2>& after = again.graph.constraints[k];
    EXPECT_EQ(after.from, before.from);
    EXPECT_EQ(after.to, before.to);
    EXPECT_EQ(after.T_from_to.coordinates(), before.T_from_to.coordinates());
    const auto triangle = Eigen::Upper;
    EXPECT_EQ(Eigen::Matrix3d(after.information.triangularView<triangle>()),
              Eigen::Matrix3d(before.information.triangularView<triangle>()));
  }
}

TEST(GraphFile, NamesNodesByIndexWithoutIds) {
  PoseGraph<SE2> graph;
  graph.poses = {SE2(), SE2(1.0, 0.25, -0.5)};
  graph.constraints.push_back({1, 0, SE2(0.1, 0, 0), Eigen::Matrix3d::Identity()});
  graph.fixed = {1};
  EXPECT_EQ(FormatGraph(graph),
            "VERTEX_SE2 0 0 0 0\n"
            "VERTEX_SE2 1 1 0.25 -0.5\n"
            "FIX 1\n"
            "EDGE_SE2 1 0 0.1 0 0 1 0 0 1 0 1\n");
}

TEST(GraphFile, AcceptsInformationThatIsOnlySemidefinite) {
  const std::string vertices = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 0 0\n";
  EXPECT_EQ(ReadText(vertices + "EDGE_SE2 0 1 0 0 0 0 0 0 0 0 0").graph.constraints.size(), 1u);
  // A bearing-like constraint: rank one, its eigenvalues zero up to rounding.
  EXPECT_EQ(
      ReadText(vertices + "EDGE_SE2 0 1 0 0 0 1 0.3 0.7 0.09 0.21 0.49").graph.constraints.size(),
      1u);
}

TEST(GraphFile, RefusesWhatItDoesNotUnderstandWithFileAndLine) {
  const std::string vertices = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 0 0\n";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"VERTEX_SE3:QUAT 2 0 0 0 0 0 0 1", "VERTEX_SE3:QUAT in a 2D graph"},
      {"vertex_se2 2 0 0 0", "unknown tag"},
      {"VERTEX_SE2 2 0 0", "cut short, expected VERTEX_SE2 id x y theta"},
      {"VERTEX_SE2 2 0 0 0 0", "'0' follows the last field"},
      {"VERTEX_SE2 2.5 0 0 0", "'2.5' is not"},
      {"VERTEX_SE2 9223372036854775808 0 0 0", "'9223372036854775808' is not"},
      {"VERTEX_SE2 2 0 nan 0", "'nan' is not a finite number"},
      {"VERTEX_SE2 2 0 0 -inf", "'-inf' is not a finite number"},
      {"VERTEX_SE2 2 0 0 1e999", "'1e999' is not a finite number"},
      {"VERTEX_SE2 2 0 0x10 0", "'0x10' is not"},
      {"VERTEX_SE2 2 0 1,5 0", "'1,5' is not"},
      {"VERTEX_SE2 1 5 5 5", "vertex 1 for the second time"},
      {"EDGE_SE2 0 1 0 0 0 1 0 0 1 0", "cut short, expected EDGE_SE2 from to x y theta I11"},
      {"EDGE_SE2 0 1 0 0 0 1 0 0 1 0 1 7", "'7' follows the last field"},
      {"EDGE_SE2 0 1 0 0 0 inf 0 0 1 0 1", "'inf' is not a finite number"},
      {"EDGE_SE2 0 1 0 0 0 1 2 0 1 0 1", "not positive semi-definite"},
      {"EDGE_SE2 0 1 0 0 0 1 0 0 1 0 -1e-3", "not positive semi-definite"},
      {"EDGE_SE2 1 1 0 0 0 1 0 0 1 0 1", "joins vertex 1 to itself"},
      {"EDGE_SE2 0 7 0 0 0 1 0 0 1 0 1", "vertex 7 is not in the file"},
      {"FIX", "cut short, expected FIX id"},
      {"FIX 0 x", "'x' is not"},
      {"FIX 8", "vertex 8 is not in the file"},
      {std::string("VERTEX_SE2 2 0 0 0\0", 19), "'0?' is not a finite number"},
      {std::string(2 << 20, 'x'), "too long"},
  };
  for (const auto& [line, message] : cases) {
    const test_support::MemoryFile file(vertices + line + "\n");
    try {
      ReadGraphOf<SE2>(file.path());
      ADD_FAILURE() << "accepted: " << line.substr(0, 80);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInput);
      EXPECT_EQ(std::string(error.what()).find(file.path() + ":3: "), 0u) << error.what();
      EXPECT_THAT(error.what(), HasSubstr(message));
    }
  }
}

TEST(GraphFile, RefusesFilesWithoutAVertex) {
  EXPECT_THROW(ReadText(""), Error);
  EXPECT_THROW(ReadText("# nothing\n\n"), Error);
  EXPECT_THROW(ReadText("FIX 0\n"), Error);
  EXPECT_THROW(ReadGraphOf<SE2>("/nonexistent/graph.g2o"), Error);
}

TEST(GraphFile, WritingWhereOneCannotIsAnOutputError) {
  try {
    WriteGraph("/nonexistent/graph.g2o", PoseGraph<SE2>());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kOutput);
  }
}

}  // namespace
}  // namespace loopgrid
