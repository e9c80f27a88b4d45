#include "backend/files/graph_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "backend/base/gzip.h"
#include "tests/support/graph_texts.h"
#include "tests/support/graphs.h"
#include "tests/support/poses.h"
#include "tests/support/recordings.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::ExpectLinesRefused;
using test_support::MemoryFile;
using test_support::ReadGraphText;
using test_support::Refusal;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

template <typename Matrix>
Matrix UpperPart(const Matrix& matrix) {
  return matrix.template triangularView<Eigen::Upper>();
}

void ExpectSamePose(const SE2& a, const SE2& b) { EXPECT_EQ(a.coordinates(), b.coordinates()); }

void ExpectSamePose(const SE3& a, const SE3& b) {
  EXPECT_EQ(a.translation(), b.translation());
  EXPECT_EQ(a.quaternion().coeffs(), b.quaternion().coeffs());
}

/// To the last bit.
template <typename Pose>
void ExpectSameGraph(const PoseGraph<Pose>& a, const PoseGraph<Pose>& b) {
  ASSERT_EQ(a.poses.size(), b.poses.size());
  for (std::size_t i = 0; i < a.poses.size(); ++i) ExpectSamePose(a.poses[i], b.poses[i]);
  EXPECT_EQ(a.landmarks, b.landmarks);
  EXPECT_EQ(a.fixed, b.fixed);
  ASSERT_EQ(a.constraints.size(), b.constraints.size());
  for (std::size_t k = 0; k < a.constraints.size(); ++k) {
    EXPECT_EQ(a.constraints[k].from, b.constraints[k].from);
    EXPECT_EQ(a.constraints[k].to, b.constraints[k].to);
    ExpectSamePose(a.constraints[k].T_from_to, b.constraints[k].T_from_to);
    EXPECT_EQ(UpperPart(a.constraints[k].information), UpperPart(b.constraints[k].information));
  }
  ASSERT_EQ(a.observations.size(), b.observations.size());
  for (std::size_t k = 0; k < a.observations.size(); ++k) {
    EXPECT_EQ(a.observations[k].node, b.observations[k].node);
    EXPECT_EQ(a.observations[k].landmark, b.observations[k].landmark);
    EXPECT_EQ(a.observations[k].p_node, b.observations[k].p_node);
    EXPECT_EQ(UpperPart(a.observations[k].information), UpperPart(b.observations[k].information));
  }
}

/// A graph with all that a file has a place for, and awkward numbers.
template <typename Pose>
GraphFile<Pose> AwkwardGraph(unsigned seed, int landmarks) {
  GraphFile<Pose> file;
  file.graph = test_support::RandomGraph<Pose>(60, 40, seed, landmarks);
  file.graph.fixed = {3, 59};
  typename Pose::Point far = Pose::Point::Constant(1e-300);
  far[1] = 123456789.123456789;
  std::mt19937 random(seed);
  file.graph.poses[7] = test_support::PoseWithAngle<Pose>(far, -std::numbers::pi, &random);
  file.graph.poses[8] = Pose();
  for (int i = 0; i < 60; ++i) file.ids.nodes.push_back(1000000007LL * (i % 7 - 3) - i);
  for (int i = 0; i < landmarks; ++i) file.ids.landmarks.push_back(50 - i);
  file.ids.nodes[59] = std::numeric_limits<std::int64_t>::min();
  return file;
}

template <typename Pose>
class RoundTripTest : public ::testing::Test {};
TYPED_TEST_SUITE(RoundTripTest, test_support::AllPoses, test_support::PoseName);

TYPED_TEST(RoundTripTest, LosesNothingInG2o) {
  const test_support::TemporaryDirectory folder;
  for (const char* name : {"graph.g2o", "graph.g2o.gz", "graph"}) {
    for (unsigned seed = 1; seed < 6; ++seed) {
      const auto file = AwkwardGraph<TypeParam>(seed, 20);
      WriteGraph(folder.File(name), file.graph, file.ids);
      const auto again = ReadGraphOf<TypeParam>(folder.File(name));
      EXPECT_EQ(again.ids.nodes, file.ids.nodes);
      EXPECT_EQ(again.ids.landmarks, file.ids.landmarks);
      ExpectSameGraph(again.graph, file.graph);
    }
  }
}

TYPED_TEST(RoundTripTest, LosesNothingButRoundingInToro) {
  const test_support::TemporaryDirectory folder;
  for (const char* name : {"graph.graph", "graph.toro", "graph.graph.gz"}) {
    const auto file = AwkwardGraph<TypeParam>(7, 0);
    WriteGraph(folder.File(name), file.graph, file.ids);
    const auto again = ReadGraphOf<TypeParam>(folder.File(name));
    EXPECT_EQ(again.ids.nodes, file.ids.nodes);
    EXPECT_EQ(again.graph.fixed, file.graph.fixed);
    for (std::size_t i = 0; i < file.graph.poses.size(); ++i) {
      EXPECT_LT(test_support::Distance(again.graph.poses[i], file.graph.poses[i]), 1e-14);
    }
    ASSERT_EQ(again.graph.constraints.size(), file.graph.constraints.size());
    for (std::size_t k = 0; k < file.graph.constraints.size(); ++k) {
      const Constraint<TypeParam>& before = file.graph.constraints[k];
      const Constraint<TypeParam>& after = again.graph.constraints[k];
      EXPECT_EQ(after.from, before.from);
      EXPECT_EQ(after.to, before.to);
      EXPECT_LT(test_support::Distance(after.T_from_to, before.T_from_to), 1e-14);
      EXPECT_LT((after.information - before.information).norm(), 1e-13 * before.information.norm());
    }
  }
}

TEST(GraphFile, RoundTripsInThePlaneLoseNothingInToroEither) {
  const auto file = AwkwardGraph<SE2>(9, 0);
  const auto again = ReadGraphText<SE2>(FormatGraph(file.graph, file.ids, GraphFormat::kToro));
  EXPECT_EQ(again.ids.nodes, file.ids.nodes);
  ExpectSameGraph(again.graph, file.graph);
}

TEST(GraphFile, IsKnownByItsContent) {
  const std::string edge = " 0 1 0 0 0 1 0 0 1 0 1\n";
  EXPECT_EQ(ReadGraph(MemoryFile("VERTEX_SE2 0 0 0 0\n").path()).index(), 0U);
  EXPECT_EQ(ReadGraph(MemoryFile("VERTEX2 0 0 0 0\n").path()).index(), 0U);
  EXPECT_EQ(ReadGraph(MemoryFile("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n").path()).index(), 1U);
  EXPECT_EQ(ReadGraph(MemoryFile("VERTEX3 0 0 0 0 0 0 0\n").path()).index(), 1U);
  EXPECT_EQ(ReadGraph(MemoryFile(Gzip("VERTEX3 0 0 0 0 0 0 0\n")).path()).index(), 1U);
  EXPECT_EQ(ReadGraph(MemoryFile("FIX 0\n\n# 3D?\nEDGE_SE2" + edge).path()).index(), 0U);
}

TEST(GraphFile, PassesOverCommentsEmptyLinesAndForeignLineEnds) {
  const auto read = ReadGraphText<SE2>(
      "\xEF\xBB\xBF# a comment\r\n\r\nVERTEX_SE2 0 0 0 0\r\n  \t\r\n#SEQUENTIAL\r\n"
      "VERTEX_SE2 1 1 2 3\r\nFIX 1");
  EXPECT_THAT(read.ids.nodes, ElementsAre(0, 1));
  EXPECT_EQ(read.graph.poses[1].coordinates(), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_THAT(read.graph.fixed, ElementsAre(1));
}

TEST(GraphFile, MixedDimensionsAreRefusedWithTheLine) {
  ExpectLinesRefused("VERTEX_SE2 0 0 0 0\n",
                     {{"VERTEX_SE3:QUAT 1 0 0 0 0 0 0 1", "VERTEX_SE3:QUAT in a 2D graph"},
                      {"EDGE3 0 1 whatever", "EDGE3 in a 2D graph"},
                      {"PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1", "PARAMS_SE3OFFSET in a 2D graph"}});
  ExpectLinesRefused("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n",
                     {{"VERTEX_SE2 1 0 0 0", "VERTEX_SE2 in a 3D graph"},
                      {"VERTEX_XY 1 0 0", "VERTEX_XY in a 3D graph"},
                      {"EDGE2 0 1 whatever", "EDGE2 in a 3D graph"}});
}

TEST(GraphFile, AFileOfTheOtherDimensionIsRefused) {
  const MemoryFile file("VERTEX_SE2 0 0 0 0\n");
  try {
    ReadGraphOf<SE3>(file.path());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInput);
    EXPECT_EQ(error.what(), file.path() + ": not a 3D graph");
  }
}

TEST(GraphFile, UnknownTagsAreRefusedWithTheLine) {
  ExpectLinesRefused("VERTEX_SE2 0 0 0 0\n",
                     {{"VERTEX_CAM 1 2 3", "unknown tag 'VERTEX_CAM'"},
                      {"vertex_se2 2 0 0 0", "unknown tag 'vertex_se2'"},
                      {"VERTEX_SE2:QUAT 2 0 0 0", "unknown tag 'VERTEX_SE2:QUAT'"},
                      {"\x1b[31m 2", "unknown tag '?[31m'"},
                      {"0", "unknown tag '0'"}});
}

TEST(GraphFile, LenientReadingPassesOverUnknownTagsAndCountsThem) {
  std::string text = "EDGE_CAM 1\nVERTEX_SE2 0 0 0 0\n";
  for (int i = 0; i < 5; ++i) text += "VERTEX_CAM 1 2 3\n";
  const MemoryFile file(text);
  GraphNotes notes;
  const auto read = ReadGraphOf<SE2>(file.path(), {.lenient = true}, &notes);
  EXPECT_EQ(read.graph.poses.size(), 1U);
  EXPECT_EQ(notes.unknown_tags.count, 6);
  EXPECT_THAT(notes.unknown_tags.messages,
              ElementsAre(file.path() + ":1: unknown tag 'EDGE_CAM', passed over",
                          file.path() + ":3: unknown tag 'VERTEX_CAM', passed over",
                          file.path() + ":4: unknown tag 'VERTEX_CAM', passed over"));
  EXPECT_EQ(ReadGraphOf<SE2>(file.path(), {.lenient = true}).graph.poses.size(), 1U);
}

TEST(GraphFile, DataThatG2oKeepsBesideTheGraphArePassedOverAndCounted) {
  const MemoryFile file(
      "PARAMS_SE2OFFSET 0 0 0 0\n"
      "VERTEX_SE2 0 0 0 0\n"
      "ROBOTLASER1 0 -1.57 3.14 0.0174 50 0.1 0 3 1.5 1.6 1.7 0 0 0 0 0 0 0 0 0 0 0 1.25 host 1\n"
      "VERTEX_SE2 1 1 0 0\n"
      "RAWLASER1 0 -1.57 3.14 0.0174 50 0.1 0 2 1.5 nan 0 1.25 host 1\n"
      "VERTEX_TAG 4 door\n"
      "VERTEX_ELLIPSE 1 0 0 1 0 1 0\n"
      "PARAMS_CAMERACALIB 1\n"
      "FIX 1\n"
      "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n");
  GraphNotes notes;
  const auto read = ReadGraphOf<SE2>(file.path(), {}, &notes);
  EXPECT_EQ(read.graph.poses.size(), 2U);
  EXPECT_EQ(read.graph.constraints.size(), 1U);
  EXPECT_THAT(read.graph.fixed, ElementsAre(1));
  EXPECT_EQ(notes.data_lines.count, 6);
  EXPECT_THAT(
      notes.data_lines.messages,
      ElementsAre(file.path() + ":1: 'PARAMS_SE2OFFSET' is no part of the graph, passed over",
                  file.path() + ":3: 'ROBOTLASER1' is no part of the graph, passed over",
                  file.path() + ":5: 'RAWLASER1' is no part of the graph, passed over"));
  EXPECT_EQ(notes.unknown_tags.count, 0);
}

TEST(GraphFile, EdgesAndVerticesThatAreNotUnderstoodAreNoData) {
  ExpectLinesRefused("VERTEX_SE2 0 0 0 0\n",
                     {{"EDGE_PRIOR_SE2 0 1 0 0 1 0 0 1 0 1", "unknown tag 'EDGE_PRIOR_SE2'"},
                      {"EDGE_SE2_OFFSET 0 1 0 0 1 0 0 1 0 0 1 0 1", "unknown tag"},
                      {"VERTEX_TAGS 0", "unknown tag"},
                      {"ROBOTLASER 0", "unknown tag"},
                      {"PARAMS", "unknown tag"}});
}

TEST(GraphFile, LenientReadingRefusesAllElse) {
  EXPECT_THROW(ReadGraphText<SE2>("VERTEX_SE2 0 0 0\n", nullptr, true), Error);
  EXPECT_THROW(ReadGraphText<SE2>("VERTEX_SE2 0 0 0 0\nFIX 1\n", nullptr, true), Error);
  EXPECT_THROW(ReadGraphText<SE2>("VERTEX_CAM 0 0 0 0\n", nullptr, true), Error);
}

TEST(GraphFile, NothingIsNotedOfACleanFile) {
  GraphNotes notes;
  ReadGraphText<SE3>("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n", &notes);
  EXPECT_EQ(notes.data_lines.count, 0);
  EXPECT_EQ(notes.unknown_tags.count, 0);
  EXPECT_EQ(notes.indefinite_information.count, 0);
  EXPECT_EQ(notes.normalized_quaternions.count, 0);
  EXPECT_EQ(notes.guessed_nodes, 0);
}

TEST(GraphFile, FixWithoutANameIsRefused) {
  ExpectLinesRefused("VERTEX_SE2 0 0 0 0\n",
                     {{"FIX", "cut short, expected FIX id ..."}, {"FIX 0 x", "'x' is not"}});
}

TEST(GraphFile, RefusesFilesWithoutAGraph) {
  for (const char* text : {"", "# nothing\n\n", "FIX 0\n", "PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\n"}) {
    EXPECT_THAT(Refusal(text), HasSubstr("no vertex and no edge, expected a g2o or TORO file"));
  }
  EXPECT_THROW(ReadGraph("/nonexistent/graph.g2o"), Error);
}

TEST(GraphFile, AGzippedFileThatIsCutIsRefused) {
  const std::string packed = Gzip(FormatGraph(test_support::RandomGraph(50, 0, 1)));
  EXPECT_THAT(Refusal(packed.substr(0, packed.size() / 2)), HasSubstr("cut short"));
}

TEST(GraphFile, TheNameChoosesTheFormatToWrite) {
  for (const char* name : {"a.graph", "b/a.toro", "a.graph.gz", "a.toro.gz"}) {
    EXPECT_EQ(GraphFormatOf(name), GraphFormat::kToro) << name;
  }
  for (const char* name : {"a.g2o", "a", "a.g2o.gz", "graph", "a.graph.txt", "a.graph/b", ""}) {
    EXPECT_EQ(GraphFormatOf(name), GraphFormat::kG2o) << name;
  }
}

TEST(GraphFile, WhatIsWrittenIsPlainOrGzippedAsTheNameSays) {
  const test_support::TemporaryDirectory folder;
  PoseGraph<SE2> graph;
  graph.poses = {SE2(1, 2, 3)};
  WriteGraph(folder.File("a.g2o"), graph);
  WriteGraph(folder.File("a.g2o.gz"), graph);
  WriteGraph(folder.File("a.graph"), graph);
  EXPECT_EQ(test_support::ReadFile(folder.File("a.g2o")), "VERTEX_SE2 0 1 2 3\n");
  EXPECT_EQ(test_support::ReadFile(folder.File("a.graph")), "VERTEX2 0 1 2 3\n");
  EXPECT_EQ(test_support::ReadFile(folder.File("a.g2o.gz")), Gzip("VERTEX_SE2 0 1 2 3\n"));
}

TYPED_TEST(RoundTripTest, LandmarksHaveNoPlaceInToro) {
  const test_support::TemporaryDirectory folder;
  PoseGraph<TypeParam> graph;
  graph.landmarks.push_back(TypeParam::Point::Zero());
  EXPECT_THROW(FormatGraph(graph, {}, GraphFormat::kToro), Error);
  try {
    WriteGraph(folder.File("a.graph"), graph);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kOutput);
    EXPECT_EQ(error.what(), folder.File("a.graph") + ": the TORO format has no landmarks");
  }
  EXPECT_THAT(folder.Names(), IsEmpty());
}

TEST(GraphFile, WritingWhereOneCannotIsAnOutputError) {
  try {
    WriteGraph("/nonexistent/graph.g2o", PoseGraph<SE2>());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kOutput);
  }
}

struct PublicGraph {
  const char* file;
  std::size_t nodes;
  std::size_t constraints;
};

class PublicGraphTest : public ::testing::TestWithParam<PublicGraph> {};

TEST_P(PublicGraphTest, IsReadWholeAndComesBackFromG2o) {
  LOOPGRID_REQUIRE_RECORDING(path, std::string("graphs/") + GetParam().file);
  GraphNotes notes;
  const AnyGraphFile read = ReadGraph(path, {}, &notes);
  EXPECT_EQ(notes.normalized_quaternions.count, 0);
  std::visit(
      [](const auto& file) {
        EXPECT_EQ(file.graph.poses.size(), GetParam().nodes);
        EXPECT_EQ(file.graph.constraints.size(), GetParam().constraints);
        EXPECT_THAT(file.graph.landmarks, IsEmpty());
        const MemoryFile written(FormatGraph(file.graph, file.ids));
        const AnyGraphFile again = ReadGraph(written.path());
        ExpectSameGraph(std::get<std::decay_t<decltype(file)>>(again).graph, file.graph);
      },
      read);
}

INSTANTIATE_TEST_SUITE_P(
    Graphs, PublicGraphTest,
    ::testing::Values(
        PublicGraph{"intel.g2o", 1728, 2512}, PublicGraph{"intel-hard-start.g2o", 1228, 1483},
        PublicGraph{"intel-943.g2o", 943, 1837}, PublicGraph{"mitb-hard-start.g2o", 808, 827},
        PublicGraph{"fr079.graph", 989, 1217}, PublicGraph{"manhattan3500.g2o", 3500, 5598},
        PublicGraph{"m3500-hard-start.g2o", 3500, 5453}, PublicGraph{"city10000.g2o", 10000, 20687},
        PublicGraph{"sphere2500.g2o", 2500, 4949}, PublicGraph{"sphere-mednoise.graph", 2200, 8647},
        PublicGraph{"sphere-bignoise.graph", 2200, 8647},
        PublicGraph{"sphere-bignoise.g2o", 2200, 8647}, PublicGraph{"torus3D.g2o", 5000, 9048},
        PublicGraph{"parking-garage.g2o", 1661, 6275}, PublicGraph{"smallGrid3D.g2o", 125, 297}),
    [](const auto& test) {
      std::string name = test.param.file;
      std::replace_if(
          name.begin(), name.end(), [](char c) { return c == '-' || c == '.'; }, '_');
      return name;
    });

}  // namespace
}  // namespace loopgrid
