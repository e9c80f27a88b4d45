#include "backend/files/g2o_format.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>
#include <string>

#include "backend/graph/constraint_error.h"
#include "tests/support/graph_texts.h"

namespace loopgrid {
namespace {

using test_support::ExpectLinesRefused;
using test_support::ReadGraphText;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(G2oFormat, ReadsTheLinesOfThePlane) {
  const auto read = ReadGraphText<SE2>(
      "VERTEX_SE2 9000000000 1.5 -2.5 0.25\n"
      "\tVERTEX_SE2  70   +1e1 .5 -3.5 \n"
      "VERTEX_XY 3 -4 5\n"
      "EDGE_SE2 70 9000000000 1 2 0.5 11 12 13 22 23 33000\n"
      "EDGE_SE2_XY 70 3 6 7 8 1 9\n");
  EXPECT_THAT(read.ids.nodes, ElementsAre(9000000000, 70));
  EXPECT_EQ(read.graph.poses[0].coordinates(), Eigen::Vector3d(1.5, -2.5, 0.25));
  EXPECT_EQ(read.graph.poses[1].coordinates(), Eigen::Vector3d(10.0, 0.5, NormalizeAngle(-3.5)));
  EXPECT_EQ(read.graph.landmarks[0], Eigen::Vector2d(-4.0, 5.0));
  const Constraint<SE2>& constraint = read.graph.constraints.at(0);
  EXPECT_EQ(constraint.T_from_to.coordinates(), Eigen::Vector3d(1.0, 2.0, 0.5));
  EXPECT_EQ(constraint.information,
            (Eigen::Matrix3d() << 11, 12, 13, 12, 22, 23, 13, 23, 33000).finished());
  const LandmarkObservation<SE2>& observation = read.graph.observations.at(0);
  EXPECT_EQ(observation.p_node, Eigen::Vector2d(6.0, 7.0));
  EXPECT_EQ(observation.information, (Eigen::Matrix2d() << 8, 1, 1, 9).finished());
}

TEST(G2oFormat, ReadsTheLinesOfSpace) {
  const auto read = ReadGraphText<SE3>(
      "VERTEX_SE3:QUAT 5 1 2 3 0.5 -0.5 0.5 -0.5\n"
      "VERTEX_SE3:QUAT 6 0 0 0 0 0 0 1\n"
      "EDGE_SE3:QUAT 6 5 1 2 3 0 0.6 0 0.8 "
      "101 2 3 4 5 6 107 8 9 10 11 112 13 14 15 116 17 18 119 20 121\n");
  EXPECT_EQ(read.graph.poses[0].translation(), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(read.graph.poses[0].quaternion().coeffs(), Eigen::Vector4d(-0.5, 0.5, -0.5, 0.5));
  const Constraint<SE3>& constraint = read.graph.constraints.at(0);
  EXPECT_TRUE(constraint.T_from_to.quaternion().coeffs().isApprox(
      Eigen::Vector4d(0.0, 0.6, 0.0, 0.8), 1e-15));
  Eigen::Matrix<double, 6, 6> expected;
  expected << 101, 2, 3, 4, 5, 6,  //
      2, 107, 8, 9, 10, 11,        //
      3, 8, 112, 13, 14, 15,       //
      4, 9, 13, 116, 17, 18,       //
      5, 10, 14, 17, 119, 20,      //
      6, 11, 15, 18, 20, 121;
  EXPECT_EQ(constraint.information, expected);
}

TEST(G2oFormat, TakesWhatASensorSawIntoTheNodesFrame) {
  // The sensor looks to the left: a quarter turn about z.
  const auto read = ReadGraphText<SE3>(
      "PARAMS_SE3OFFSET 4 10 20 30 0 0 0.70710678118654757 0.70710678118654757\n"
      "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"
      "VERTEX_TRACKXYZ 1 8 21 33\n"
      "EDGE_SE3_TRACKXYZ 0 1 4 1 2 3 5 1 2 6 3 7\n");
  const LandmarkObservation<SE3>& observation = read.graph.observations.at(0);
  EXPECT_TRUE(observation.p_node.isApprox(Eigen::Vector3d(8.0, 21.0, 33.0), 1e-14));
  EXPECT_TRUE(observation.information.isApprox(
      (Eigen::Matrix3d() << 6, -1, -3, -1, 5, 2, -3, 2, 7).finished(), 1e-14));
  EXPECT_NEAR(TotalChi2(read.graph), 0.0, 1e-20);
}

TEST(G2oFormat, WrongSensorsAreRefusedWithTheirLine) {
  ExpectLinesRefused(
      "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nPARAMS_SE3OFFSET 4 0 0 0 0 0 0 1\n"
      "VERTEX_TRACKXYZ 1 8 21 33\n",
      {{"EDGE_SE3_TRACKXYZ 0 1 5 1 2 3 1 0 0 1 0 1", "parameter 5 is not in"},
       {"EDGE_SE3_TRACKXYZ 0 1 4 1 2 3 1 0 0 1 0 -1", "semi-definite"},
       {"EDGE_SE3_TRACKXYZ 0 1 4 1 2 3 1 0 0 1 0", "node landmark sensor x y z"},
       {"PARAMS_SE3OFFSET 4 0 0 0 0 0 0 1", "parameter 4 for the second time"}});
  ExpectLinesRefused(
      "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nPARAMS_SE3OFFSET 4 1e308 0 0 0 0 0 1\n"
      "VERTEX_TRACKXYZ 1 8 21 33\n",
      {{"EDGE_SE3_TRACKXYZ 0 1 4 1e308 0 0 1 0 0 1 0 1", "too far away"}});
}

TEST(G2oFormat, NormalisesQuaternionsWithANote) {
  GraphNotes notes;
  const test_support::MemoryFile file(
      "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"
      "VERTEX_SE3:QUAT 1 0 0 0 0 0 3 4\n"
      "VERTEX_SE3:QUAT 2 0 0 0 0 0 0 1e-300\n"
      "VERTEX_SE3:QUAT 3 0 0 0 1e300 0 0 -1e300\n"
      "VERTEX_SE3:QUAT 4 0 0 0 0.182574 0.365148 0.547723 0.730297\n"  // six digits: no note
      "EDGE_SE3:QUAT 0 1 0 0 0 0 0 0 1.001 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n");
  const auto read = ReadGraphOf<SE3>(file.path(), {}, &notes);
  const double half = std::numbers::sqrt2 / 2.0;
  EXPECT_TRUE(read.graph.poses[1].quaternion().coeffs().isApprox(
      Eigen::Vector4d(0.0, 0.0, 0.6, 0.8), 1e-15));
  EXPECT_EQ(read.graph.poses[2].quaternion().coeffs(), Eigen::Vector4d(0.0, 0.0, 0.0, 1.0));
  EXPECT_TRUE(read.graph.poses[3].quaternion().coeffs().isApprox(
      Eigen::Vector4d(-half, 0.0, 0.0, half), 1e-15));
  EXPECT_NEAR(read.graph.poses[4].quaternion().norm(), 1.0, 1e-15);
  EXPECT_EQ(notes.normalized_quaternions.count, 4);
  EXPECT_THAT(notes.normalized_quaternions.messages,
              ElementsAre(file.path() + ":2: a quaternion of length 5, normalised",
                          file.path() + ":3: a quaternion of length 1e-300, normalised",
                          file.path() + ":4: a quaternion of length 1.41421e+300, normalised"));
}

TEST(G2oFormat, RefusesAQuaternionOfLengthZero) {
  ExpectLinesRefused("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n",
                     {{"VERTEX_SE3:QUAT 1 0 0 0 0 0 0 0", "the quaternion is zero"},
                      {"VERTEX_SE3:QUAT 1 0 0 0 0 nan 0 0", "'nan' is not a finite number"},
                      {"VERTEX_SE3:QUAT 1 0 0 0 0 0 0", "id x y z qx qy qz qw"}});
}

TEST(G2oFormat, EveryFieldOfEveryLineIsNeeded) {
  for (const std::string line : {"VERTEX_SE2 2 0 0 0", "VERTEX_XY 3 0 0",
                                 "EDGE_SE2 0 1 0 0 0 1 0 0 1 0 1", "EDGE_SE2_XY 0 9 0 0 1 0 1"}) {
    const std::string good = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 0 0\nVERTEX_XY 9 0 0\n";
    ExpectLinesRefused(good, {{line.substr(0, line.rfind(' ')), "cut short"},
                              {line + " 1", "follows the last field"}});
  }
  for (const std::string line :
       {"VERTEX_SE3:QUAT 2 0 0 0 0 0 0 1", "VERTEX_TRACKXYZ 3 0 0 0",
        "EDGE_SE3:QUAT 0 1 0 0 0 0 0 0 1 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1",
        "EDGE_SE3_TRACKXYZ 0 9 5 0 0 0 1 0 0 1 0 1", "PARAMS_SE3OFFSET 6 0 0 0 0 0 0 1"}) {
    const std::string good =
        "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 0 0 0 0 0 0 1\n"
        "VERTEX_TRACKXYZ 9 0 0 0\nPARAMS_SE3OFFSET 5 0 0 0 0 0 0 1\n";
    ExpectLinesRefused(good, {{line.substr(0, line.rfind(' ')), "cut short"},
                              {line + " 1", "follows the last field"}});
  }
}

TEST(G2oFormat, NamesVerticesByIndexWithoutIds) {
  PoseGraph<SE2> graph;
  graph.poses = {SE2(), SE2(1.0, 0.25, -0.5)};
  graph.landmarks = {Eigen::Vector2d(3.0, 4.0)};
  graph.constraints.push_back({1, 0, SE2(0.1, 0, 0), Eigen::Matrix3d::Identity()});
  graph.observations.push_back(
      {1, 0, Eigen::Vector2d(2.0, 1e-9), (Eigen::Matrix2d() << 5, 1, 1, 6).finished()});
  graph.fixed = {1};
  EXPECT_EQ(FormatG2o(graph, {}),
            "VERTEX_SE2 0 0 0 0\n"
            "VERTEX_SE2 1 1 0.25 -0.5\n"
            "VERTEX_XY 2 3 4\n"
            "FIX 1\n"
            "EDGE_SE2 1 0 0.1 0 0 1 0 0 1 0 1\n"
            "EDGE_SE2_XY 1 2 2 1e-09 5 1 6\n");
}

TEST(G2oFormat, WritesGraphsOfSpace) {
  PoseGraph<SE3> graph;
  graph.poses = {SE3(Eigen::Vector3d(1, 2, 3), Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5))};
  graph.landmarks = {Eigen::Vector3d(7, 8, 9)};
  EXPECT_EQ(FormatG2o(graph, {{50}, {60}}),
            "VERTEX_SE3:QUAT 50 1 2 3 0.5 -0.5 0.5 0.5\nVERTEX_TRACKXYZ 60 7 8 9\n");
  graph.observations.push_back({0, 0, Eigen::Vector3d(4, 5, 6), Eigen::Matrix3d::Identity()});
  EXPECT_EQ(FormatG2o(graph, {{50}, {60}}),
            "PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\n"
            "VERTEX_SE3:QUAT 50 1 2 3 0.5 -0.5 0.5 0.5\nVERTEX_TRACKXYZ 60 7 8 9\n"
            "EDGE_SE3_TRACKXYZ 50 60 0 4 5 6 1 0 0 1 0 1\n");
}

}  // namespace
}  // namespace loopgrid
