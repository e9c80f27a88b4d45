#include "backend/sparse/exact_elimination.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

namespace loopgrid {
namespace {

/// The lower triangle of a matrix as a front, and room for its panel.
struct ExactFront {
  explicit ExactFront(const Eigen::MatrixXd& matrix)
      : size(static_cast<int>(matrix.rows())),
        values(static_cast<std::size_t>(size * size)),
        panel(values.size(), 0.0) {
    for (int j = 0; j < size; ++j) {
      for (int i = j; i < size; ++i) at(i, j) = matrix(i, j);
    }
  }
  DoubleDouble& at(int i, int j) { return values[static_cast<std::size_t>(i + size * j)]; }
  double factor(int i, int j) const { return panel[static_cast<std::size_t>(i + size * j)]; }
  Definiteness Eliminate(int pivots, double noise_of_each = 1e-20) {
    noise.assign(static_cast<std::size_t>(size), noise_of_each);
    return EliminateExactly(values.data(), size, size, pivots, noise.data(), panel.data());
  }

  int size;
  std::vector<DoubleDouble> values;
  std::vector<double> panel;
  std::vector<double> noise;
};

TEST(ExactElimination, GivesTheFactorAndTheSchurComplement) {
  std::srand(3);
  for (int size = 1; size <= 12; ++size) {
    for (int pivots = 1; pivots <= size; ++pivots) {
      const Eigen::MatrixXd root = Eigen::MatrixXd::Random(size, size + 2);
      const Eigen::MatrixXd F = root * root.transpose() + Eigen::MatrixXd::Identity(size, size);
      ExactFront front(F);
      ASSERT_EQ(front.Eliminate(pivots), Definiteness::kDefinite);
      Eigen::MatrixXd L = Eigen::MatrixXd::Zero(size, size);
      for (int j = 0; j < pivots; ++j) {
        for (int i = j; i < size; ++i) L(i, j) = front.factor(i, j);
      }
      Eigen::MatrixXd rebuilt = L * L.transpose();
      for (int j = pivots; j < size; ++j) {
        for (int i = j; i < size; ++i) rebuilt(i, j) += front.at(i, j).high;
      }
      const Eigen::MatrixXd lower = F.triangularView<Eigen::Lower>();
      ASSERT_TRUE(Eigen::MatrixXd(rebuilt.triangularView<Eigen::Lower>()).isApprox(lower, 1e-14))
          << size << " columns, " << pivots << " pivots";
    }
  }
}

// A stiff spring between two weak ones: 1e-4 is less than the last digit of 1e16.
TEST(ExactElimination, SeesASpringThatDoubleLoses) {
  Eigen::Matrix2d stiff;
  stiff << 1e16, -1e16, -1e16, 1e16;
  ExactFront front(stiff);
  front.at(1, 1) += DoubleDouble(1e-4);
  ASSERT_EQ(front.Eliminate(2), Definiteness::kDefinite);
  EXPECT_NEAR(front.factor(1, 1), 1e-2, 1e-14);
}

TEST(ExactElimination, HoldsTheVariableOfAFreeDirection) {
  Eigen::Matrix3d F;
  F << 4.0, 2.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 9.0;
  ExactFront front(F);
  EXPECT_EQ(front.Eliminate(3), Definiteness::kSemidefinite);
  EXPECT_EQ(front.factor(1, 0), 1.0);
  EXPECT_TRUE(std::isinf(front.factor(1, 1)));
  EXPECT_EQ(front.factor(2, 1), 0.0);
  EXPECT_EQ(front.factor(2, 2), 3.0);
}

TEST(ExactElimination, TellsHowThePivotsErrorSpreads) {
  Eigen::Matrix3d F;
  F << 4.0, 2.0, 8.0, 2.0, 9.0, 0.0, 8.0, 0.0, 99.0;
  ExactFront front(F);
  ASSERT_EQ(front.Eliminate(1, 1e-6), Definiteness::kDefinite);
  EXPECT_NEAR(front.noise[1], 1e-6 + 0.25e-6, 1e-18);
  EXPECT_NEAR(front.noise[2], 1e-6 + 4e-6, 1e-18);
}

TEST(ExactElimination, SaysThatANegativePivotIsIndefinite) {
  ExactFront negative(Eigen::Matrix2d{{1.0, 2.0}, {2.0, 1.0}});
  EXPECT_EQ(negative.Eliminate(2), Definiteness::kIndefinite);
  ExactFront nothing(Eigen::Matrix2d{{1.0, 0.0}, {0.0, std::nan("")}});
  EXPECT_EQ(nothing.Eliminate(2), Definiteness::kIndefinite);
}

}  // namespace
}  // namespace loopgrid
