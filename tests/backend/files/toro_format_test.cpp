#include "backend/files/toro_format.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <string>

#include "backend/geometry/euler.h"
#include "backend/guess/initial_guess.h"
#include "backend/solve/optimizer.h"
#include "tests/support/graph_texts.h"
#include "tests/support/graphs.h"
#include "tests/support/poses.h"
#include "tests/support/recordings.h"

namespace loopgrid {
namespace {

using test_support::ExpectLinesRefused;
using test_support::ReadGraphText;
using ::testing::ElementsAre;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

TEST(ToroFormat, ReadsTheLinesOfThePlane) {
  const auto read = ReadGraphText<SE2>(
      "VERTEX2 7 1.5 -2.5 0.25\n"
      "VERTEX 8 1 2 3\n"
      "EDGE2 8 7 1 2 0.5 11 12 22 33 13 23\n"
      "EDGE 7 8 3 4 -0.5 1 0 1 1 0 0\n");
  EXPECT_THAT(read.ids.nodes, ElementsAre(7, 8));
  EXPECT_EQ(read.graph.poses[0].coordinates(), Eigen::Vector3d(1.5, -2.5, 0.25));
  EXPECT_EQ(read.graph.poses[1].coordinates(), Eigen::Vector3d(1.0, 2.0, 3.0));
  const Constraint<SE2>& constraint = read.graph.constraints.at(0);
  EXPECT_EQ(constraint.from, 1);
  EXPECT_EQ(constraint.to, 0);
  EXPECT_EQ(constraint.T_from_to.coordinates(), Eigen::Vector3d(1.0, 2.0, 0.5));
  EXPECT_EQ(constraint.information,
            (Eigen::Matrix3d() << 11, 12, 13, 12, 22, 23, 13, 23, 33).finished());
  EXPECT_EQ(read.graph.constraints.at(1).T_from_to.coordinates(), Eigen::Vector3d(3.0, 4.0, -0.5));
}

TEST(ToroFormat, ReadsPosesOfSpace) {
  const auto read = ReadGraphText<SE3>(
      "VERTEX3 7 1 2 3 0.1 -0.2 0.3\n"
      "VERTEX3 8 0 0 0 3 1.5 -3\n"
      "EDGE3 7 8 4 5 6 -0.1 0.2 -0.3 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n");
  const auto expected = [](double x, double y, double z, double roll, double pitch, double yaw) {
    return SE3(Eigen::Vector3d(x, y, z), FromRollPitchYaw({roll, pitch, yaw}));
  };
  using test_support::Distance;
  EXPECT_LT(Distance(read.graph.poses[0], expected(1, 2, 3, 0.1, -0.2, 0.3)), 1e-15);
  EXPECT_LT(Distance(read.graph.poses[1], expected(0, 0, 0, 3, 1.5, -3)), 1e-15);
  EXPECT_LT(Distance(read.graph.constraints.at(0).T_from_to, expected(4, 5, 6, -0.1, 0.2, -0.3)),
            1e-15);
}

/// (roll, pitch, yaw) the way g2o finds them: from the rotation matrix of a quaternion that need
/// not be a unit one, by way of a quaternion again.
Eigen::Vector3d AnglesAsG2o(const Eigen::Quaterniond& raw) {
  const Eigen::Quaterniond q(raw.toRotationMatrix());
  return {std::atan2(2.0 * (q.w() * q.x() + q.y() * q.z()),
                     1.0 - 2.0 * (q.x() * q.x() + q.y() * q.y())),
          std::asin(2.0 * (q.w() * q.y() - q.z() * q.x())),
          std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()),
                     1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()))};
}

/// Its derivative by the vector part, by differences.
Matrix6d JacobianAsG2o(const Eigen::Quaterniond& q) {
  constexpr double kStep = 1e-6;
  Matrix6d J = Matrix6d::Identity();
  for (int i = 0; i < 3; ++i) {
    Eigen::Quaterniond before = q;
    Eigen::Quaterniond after = q;
    before.coeffs()[i] -= kStep;
    after.coeffs()[i] += kStep;
    J.block<3, 1>(3, 3 + i) = (AnglesAsG2o(after) - AnglesAsG2o(before)) / (2.0 * kStep);
  }
  return J;
}

SE3 PoseTurnedBy(double angle, std::mt19937* random) {
  return test_support::PoseWithAngle<SE3>(Eigen::Vector3d(1.0, 2.0, 3.0), angle, random);
}

/// The constraint after it has been to a file.
Constraint<SE3> ThereAndBack(const Constraint<SE3>& constraint) {
  PoseGraph<SE3> graph;
  graph.poses.resize(2);
  graph.constraints = {constraint};
  return ReadGraphText<SE3>(FormatToro(graph, {})).graph.constraints.at(0);
}

/// The information matrix of an EDGE3 line.
Matrix6d InformationInFile(const Constraint<SE3>& constraint) {
  PoseGraph<SE3> graph;
  graph.poses.resize(2);
  graph.constraints = {constraint};
  const std::string text = FormatToro(graph, {});
  const test_support::MemoryFile file(text.substr(text.find("EDGE3")));
  LineReader lines(file.path());
  std::string_view line;
  lines.Next(&line);
  GraphNotes notes;
  const GraphReadOptions options;
  GraphLine fields(lines, line, options, &notes);
  fields.Numbers<8>();
  return fields.UpperTriangle<6>();
}

TEST(ToroFormat, InformationOfUpToAThirdOfAHalfTurnIsThatOfG2o) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(0.0, 1.1);
  for (int round = 0; round < 200; ++round) {
    const Constraint<SE3> constraint = {0, 1, PoseTurnedBy(angle(random), &random),
                                        test_support::RandomInformation<6>(&random)};
    const Matrix6d J = JacobianAsG2o(constraint.T_from_to.quaternion());
    const Matrix6d expected = J.transpose() * InformationInFile(constraint) * J;
    EXPECT_LT((constraint.information - expected).norm(), 1e-8 * expected.norm())
        << "round " << round;
  }
}

TEST(ToroFormat, InformationOfLargerTurnsIsThatOfSmallMotions) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> angle(1.12, 3.14);
  for (int round = 0; round < 50; ++round) {
    const Constraint<SE3> constraint = {0, 1, PoseTurnedBy(angle(random), &random),
                                        test_support::RandomInformation<6>(&random)};
    Matrix6d expected = InformationInFile(constraint);
    expected.rightCols<3>() *= 2.0;
    expected.bottomRows<3>() *= 2.0;
    EXPECT_EQ(constraint.information.triangularView<Eigen::Upper>().toDenseMatrix(),
              expected.triangularView<Eigen::Upper>().toDenseMatrix())
        << "round " << round;
  }
}

TEST(ToroFormat, ConstraintsInSpaceComeBackAsTheyWere) {
  std::mt19937 random(7);
  for (int round = 0; round < 500; ++round) {
    const Constraint<SE3> before = {0, 1, test_support::RandomPose<SE3>(&random),
                                    test_support::RandomInformation<6>(&random)};
    const Constraint<SE3> after = ThereAndBack(before);
    EXPECT_EQ(after.T_from_to.translation(), before.T_from_to.translation());
    EXPECT_LT(test_support::Distance(after.T_from_to, before.T_from_to), 1e-14);
    EXPECT_LT((after.information - before.information).norm(), 1e-13 * before.information.norm())
        << "round " << round;
  }
}

TEST(ToroFormat, ConstraintsAtGimbalLockComeBackAsTheyWere) {
  for (const double away : {0.0, 1e-15, 1e-12, 1e-8, 1e-4}) {
    for (const double pitch : {M_PI / 2.0 - away, away - M_PI / 2.0}) {
      const Constraint<SE3> before = {
          0, 1, SE3(Eigen::Vector3d(1, 2, 3), FromRollPitchYaw({0.4, pitch, -0.7})),
          10.0 * Matrix6d::Identity()};
      const Constraint<SE3> after = ThereAndBack(before);
      EXPECT_LT(test_support::Distance(after.T_from_to, before.T_from_to), 1e-14) << pitch;
      EXPECT_EQ(after.information, before.information) << pitch;
    }
  }
}

TEST(ToroFormat, WrongLinesAreRefusedWithTheirLine) {
  ExpectLinesRefused("VERTEX2 0 0 0 0\nVERTEX2 1 0 0 0\n",
                     {{"VERTEX2 2 0 0", "cut short, expected VERTEX2 id x y theta"},
                      {"VERTEX 2 0 0 0 0", "follows the last field"},
                      {"EDGE2 0 1 0 0 0 1 0 1 1 0", "from to x y theta Ixx Ixy Iyy Itt Ixt Iyt"},
                      {"EDGE 0 1 0 0 0 1 0 1 1 0 0 0", "follows the last field"},
                      {"EDGE2 0 1 0 0 0 1 0 1 -1 0 0", "semi-definite"},
                      {"EDGE2 0 1 0 0 0 1 0 1 1 2 0", "semi-definite"},
                      {"VERTEX3 0 0 0 0 0 0 0", "VERTEX3 in a 2D graph"}});
  ExpectLinesRefused(
      "VERTEX3 0 0 0 0 0 0 0\nVERTEX3 1 0 0 0 0 0 0\n",
      {{"VERTEX3 2 0 0 0 0 0", "cut short, expected VERTEX3 id x y z roll pitch yaw"},
       {"VERTEX3 2 0 0 0 0 0 0 0", "follows the last field"},
       {"EDGE3 0 1 0 0 0 0 0 0 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0", "from to x y z roll"},
       {"EDGE3 0 1 0 0 0 0 0 0 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1 1", "follows the last"},
       {"EDGE3 0 1 0 0 0 0 0 0 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 -1", "semi-definite"},
       {"EDGE3 0 1 0 0 0 0 0 0 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1e308", "not finite"},
       {"EDGE2 0 1 0 0 0 1 0 1 1 0 0", "EDGE2 in a 3D graph"}});
}

TEST(ToroFormat, WritesGraphsOfThePlane) {
  PoseGraph<SE2> graph;
  graph.poses = {SE2(), SE2(1.0, 0.25, -0.5)};
  graph.constraints.push_back(
      {0, 1, SE2(0.1, 0, 0), (Eigen::Matrix3d() << 11, 2, 3, 2, 22, 4, 3, 4, 33).finished()});
  graph.fixed = {1};
  EXPECT_EQ(FormatToro(graph, {{30, 40}, {}}),
            "VERTEX2 30 0 0 0\nVERTEX2 40 1 0.25 -0.5\nFIX 40\n"
            "EDGE2 30 40 0.1 0 0 11 2 22 33 3 4\n");
}

/// F at the minimum that the spanning tree leads to.
template <typename Pose>
double ErrorFromSpanningTree(const std::string& path) {
  PoseGraph<Pose> graph = ReadGraphOf<Pose>(path).graph;
  SetSpanningTreeGuess(&graph);
  return Optimizer<Pose>().Optimize(&graph).final_error;
}

TEST(ToroFormat, PublicGraphsHaveTheirKnownMinimum) {
  LOOPGRID_REQUIRE_RECORDING(fr079, "graphs/fr079.graph");
  LOOPGRID_REQUIRE_RECORDING(sphere, "graphs/sphere-mednoise.graph");
  EXPECT_NEAR(ErrorFromSpanningTree<SE2>(fr079), 37.599116, 1e-6);
  EXPECT_NEAR(ErrorFromSpanningTree<SE3>(sphere), 395.006212, 2e-6);
}

}  // namespace
}  // namespace loopgrid
