#include "backend/files/graph_line.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <Eigen/Dense>
#include <limits>
#include <random>
#include <string>

#include "tests/support/graph_texts.h"
#include "tests/support/graphs.h"

namespace loopgrid {
namespace {

using test_support::ExpectLinesRefused;

const std::string kVertices = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 0 0\n";

TEST(GraphLine, WhatIsNoNumberIsRefusedWithItsLine) {
  ExpectLinesRefused(kVertices,
                     {
                         {"VERTEX_SE2", "cut short, expected VERTEX_SE2 id x y theta"},
                         {"VERTEX_SE2 2 0 0", "cut short, expected VERTEX_SE2 id x y theta"},
                         {"VERTEX_SE2 2 0 0 0 0", "'0' follows the last field"},
                         {"VERTEX_SE2 2.5 0 0 0", "'2.5' is not"},
                         {"VERTEX_SE2 x 0 0 0", "'x' is not"},
                         {"VERTEX_SE2 9223372036854775808 0 0 0", "'9223372036854775808' is not"},
                         {"VERTEX_SE2 2 0 nan 0", "'nan' is not a finite number"},
                         {"VERTEX_SE2 2 0 0 -inf", "'-inf' is not a finite number"},
                         {"VERTEX_SE2 2 0 0 1e999", "'1e999' is not a finite number"},
                         {"VERTEX_SE2 2 0 0x10 0", "'0x10' is not"},
                         {"VERTEX_SE2 2 0 1,5 0", "'1,5' is not"},
                         {"VERTEX_SE2 2 0 - 0", "'-' is not"},
                         {std::string("VERTEX_SE2 2 0 0 0\0", 19), "'0?' is not a finite number"},
                         {"VERTEX_SE2 2 0 0 " + std::string(100, '7') + "x",
                          "'" + std::string(40, '7') + "' is not"},
                         {std::string(2 << 20, 'x'), "too long"},
                     });
}

/// The information matrix as the file has it: its upper triangle.
template <int kSize>
std::string UpperTriangle(const Eigen::Matrix<double, kSize, kSize>& matrix) {
  std::string text;
  for (int row = 0; row < kSize; ++row) {
    for (int column = row; column < kSize; ++column) {
      text += fmt::format(" {}", matrix(row, column));
    }
  }
  return text;
}

template <int kSize>
std::string EdgeWith(const Eigen::Matrix<double, kSize, kSize>& information) {
  if constexpr (kSize == 2) {
    return "VERTEX_SE2 0 0 0 0\nVERTEX_XY 1 0 0\nEDGE_SE2_XY 0 1 0 0" + UpperTriangle(information);
  } else if constexpr (kSize == 3) {
    return kVertices + "EDGE_SE2 0 1 0 0 0" + UpperTriangle(information);
  } else {
    return "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 0 0 0 0 0 0 1\n"
           "EDGE_SE3:QUAT 0 1 0 0 0 0 0 0 1" +
           UpperTriangle(information);
  }
}

template <typename Size>
class InformationTest : public ::testing::Test {};
using Sizes = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                               std::integral_constant<int, 6>>;
TYPED_TEST_SUITE(InformationTest, Sizes);

TYPED_TEST(InformationTest, IsRefusedIfAnEigenvalueIsNegative) {
  constexpr int kSize = TypeParam::value;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  std::mt19937 random(3);
  for (int round = 0; round < 50; ++round) {
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(
        test_support::RandomInformation<kSize>(&random));
    Eigen::Matrix<double, kSize, 1> values = solver.eigenvalues();
    const auto with = [&](double smallest) {
      values[0] = smallest;
      const Matrix V = solver.eigenvectors();
      const Matrix information = V * values.asDiagonal() * V.transpose();
      return test_support::Refusal(EdgeWith<kSize>(information));
    };
    EXPECT_EQ(with(1.0), "") << "round " << round;
    EXPECT_EQ(
        with(-1.0),
        "3: the information matrix between 0 and 1 is not positive semi-definite: its smallest "
        "eigenvalue is -1")
        << "round " << round;
  }
}

TYPED_TEST(InformationTest, MayBeSemidefinite) {
  constexpr int kSize = TypeParam::value;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  EXPECT_EQ(test_support::Refusal(EdgeWith<kSize>(Matrix::Zero())), "");
  EXPECT_EQ(test_support::Refusal(EdgeWith<kSize>(Matrix::Ones())), "");
  Matrix last_only = Matrix::Zero();
  last_only(kSize - 1, kSize - 1) = 5.0;
  EXPECT_EQ(test_support::Refusal(EdgeWith<kSize>(last_only)), "");
}

TEST(GraphLine, InformationIsJudgedUpToRoundingInTheFile) {
  // Of rank one, but for rounding.
  EXPECT_EQ(test_support::Refusal(kVertices + "EDGE_SE2 0 1 0 0 0 1 0.3 0.7 0.09 0.21 0.49"), "");
  EXPECT_EQ(test_support::Refusal(kVertices + "EDGE_SE2 0 1 0 0 0 1 0 0 1 0 -1e-12"), "");
  EXPECT_EQ(test_support::Refusal(kVertices + "EDGE_SE2 0 1 0 0 0 1e6 0 0 1e6 0 -9e-4"), "");
  ExpectLinesRefused(kVertices, {
                                    {"EDGE_SE2 0 1 0 0 0 1 2 0 1 0 1", "semi-definite"},
                                    {"EDGE_SE2 0 1 0 0 0 1 0 0 1 0 -1e-3", "semi-definite"},
                                    {"EDGE_SE2 0 1 0 0 0 1e6 0 0 1e6 0 -2e-3", "is -0.002"},
                                    {"EDGE_SE2 1 0 0 0 0 1 2 0 1 0 1", "between 1 and 0 is not"},
                                    {"EDGE2 0 1 0 0 0 1 2 1 1 0 0", "eigenvalue is -1"},
                                    {"EDGE_SE2 0 1 0 0 0 0 1e-3 0 0 0 0", "semi-definite"},
                                });
}

TEST(GraphLine, EigenvaluesThatAreNegativeByRoundingBecomeZero) {
  const auto file =
      test_support::ReadGraphText<SE2>(kVertices + "EDGE_SE2 0 1 0 0 0 1 0 0 2 0 -1e-10\n");
  const Eigen::Matrix3d expected = Eigen::Vector3d(1.0, 2.0, 0.0).asDiagonal();
  EXPECT_TRUE(file.graph.constraints[0].information.isApprox(expected, 1e-15));
}

TEST(GraphLine, LenientReadingTakesTheNearestSemidefiniteInformationAndCounts) {
  // Eigenvalues 3 along (1, 1), -1 along (1, -1); and 5.
  const test_support::MemoryFile file(kVertices +
                                      "EDGE_SE2 0 1 0 0 0 1 2 0 1 0 5\n"
                                      "EDGE_SE2 1 0 0 0 0 1 0 0 1 0 1\n"
                                      "EDGE_SE2 0 1 0 0 0 -4 0 0 -4 0 -4\n");
  EXPECT_THROW(ReadGraph(file.path()), Error);
  GraphNotes notes;
  const auto read = ReadGraphOf<SE2>(file.path(), {.lenient = true}, &notes);
  Eigen::Matrix3d expected;
  expected << 1.5, 1.5, 0.0, 1.5, 1.5, 0.0, 0.0, 0.0, 5.0;
  EXPECT_TRUE(read.graph.constraints[0].information.isApprox(expected, 1e-14))
      << read.graph.constraints[0].information;
  EXPECT_EQ(read.graph.constraints[1].information, Eigen::Matrix3d::Identity());
  EXPECT_TRUE(read.graph.constraints[2].information.isZero(0.0));
  EXPECT_EQ(notes.indefinite_information.count, 2);
  EXPECT_THAT(
      notes.indefinite_information.messages,
      ::testing::ElementsAre(
          file.path() +
              ":3: the information matrix between 0 and 1 is not positive semi-definite: its "
              "smallest eigenvalue is -1; negative ones set to zero",
          file.path() +
              ":5: the information matrix between 0 and 1 is not positive semi-definite: its "
              "smallest eigenvalue is -4; negative ones set to zero"));
}

TEST(GraphLine, WhatLenientReadingMendsIsAcceptedWhenItIsReadAgain) {
  for (const char* information : {"1 2 0 1 0 1", "1e-300 1e300 0 1e-300 0 1e300", "1 1 1 1 1 0.5",
                                  "0 1e-322 0 0 0 1e-321", "1e-13 1e-11 0 0 0 1"}) {
    const auto mended = test_support::ReadGraphText<SE2>(
        kVertices + "EDGE_SE2 0 1 0 0 0 " + information, nullptr, true);
    const std::string text = FormatGraph(mended.graph, mended.ids);
    EXPECT_EQ(test_support::Refusal(text), "") << information;
    const auto again = test_support::ReadGraphText<SE2>(text);
    EXPECT_EQ(FormatGraph(again.graph, again.ids), text) << information;
  }
}

TEST(GraphLine, InformationMayBeAsLargeAndSmallAsADouble) {
  EXPECT_EQ(test_support::Refusal(kVertices + "EDGE_SE2 0 1 0 0 0 1e300 0 0 1e300 0 1e-300"), "");
  EXPECT_EQ(test_support::Refusal(kVertices + "EDGE_SE2 0 1 0 0 0 1e-300 0 0 1e-300 0 1e300"), "");
  ExpectLinesRefused(kVertices,
                     {{"EDGE_SE2 0 1 0 0 0 1e-300 1e300 0 1e-300 0 1e300", "semi-definite"},
                      {"EDGE_SE2 0 1 0 0 0 1e-320 1e300 1e300 1 1e300 1", "semi-definite"}});
}

}  // namespace
}  // namespace loopgrid
