#include "backend/sparse/frontal_kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cstdlib>
#include <random>
#include <vector>

namespace loopgrid {
namespace {

/// A matrix in the layout of the kernels, with room for groups of rows that begin in mid-column.
struct Padded {
  explicit Padded(const Eigen::MatrixXd& matrix, int first_row = 0)
      : rows(static_cast<int>(matrix.rows())),
        cols(static_cast<int>(matrix.cols())),
        ld(PaddedRows(rows + first_row)),
        offset(first_row),
        values(static_cast<std::size_t>(ld * cols + kRowAlignment), 1e6) {
    for (int j = 0; j < cols; ++j) {
      for (int i = 0; i < rows; ++i) data()[i + j * ld] = matrix(i, j);
    }
  }
  double* data() { return values.data() + offset; }
  Eigen::MatrixXd matrix() {
    return Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>(data(), rows, cols,
                                                                Eigen::OuterStride<>(ld));
  }

  int rows;
  int cols;
  int ld;
  int offset;
  std::vector<double> values;
};

TEST(FrontalKernels, ProductsAgreeWithEigenForAllSmallSizes) {
  for (int rows = 1; rows <= 13; ++rows) {
    for (int cols = 1; cols <= 7; ++cols) {
      for (int depth = 0; depth <= 5; ++depth) {
        const Eigen::MatrixXd A = Eigen::MatrixXd::Random(rows, depth);
        const Eigen::MatrixXd B = Eigen::MatrixXd::Random(depth, cols);
        const Eigen::MatrixXd C = Eigen::MatrixXd::Random(rows, cols);
        Padded a(A, 3);
        Padded b(B);
        Padded b_transposed(B.transpose());
        Padded sum(C);
        Padded difference(C);
        MultiplyAdd(sum.data(), sum.ld, a.data(), a.ld, {b.data(), 1, b.ld}, rows, cols, depth);
        MultiplySubtract(difference.data(), difference.ld, a.data(), a.ld,
                         {b_transposed.data(), b_transposed.ld, 1}, rows, cols, depth);
        ASSERT_TRUE(sum.matrix().isApprox(C + A * B, 1e-14)) << rows << cols << depth;
        ASSERT_TRUE(difference.matrix().isApprox(C - A * B, 1e-14)) << rows << cols << depth;
      }
    }
  }
}

TEST(FrontalKernels, EliminationGivesTheFactorAndTheSchurComplement) {
  std::srand(3);
  for (int size = 1; size <= 25; ++size) {
    for (int pivots = 1; pivots <= size; ++pivots) {
      const Eigen::MatrixXd root = Eigen::MatrixXd::Random(size, size + 2);
      const Eigen::MatrixXd F = root * root.transpose() + Eigen::MatrixXd::Identity(size, size);
      Padded front(F.triangularView<Eigen::Lower>());
      const std::vector<double> smallest(static_cast<std::size_t>(pivots), 0.0);
      ASSERT_TRUE(EliminateColumns(front.data(), front.ld, size, pivots, smallest.data()));

      Eigen::MatrixXd L = Eigen::MatrixXd::Zero(size, size);
      L.leftCols(pivots) = front.matrix().leftCols(pivots).triangularView<Eigen::Lower>();
      const int below = size - pivots;
      Eigen::MatrixXd rebuilt = L * L.transpose();
      const Eigen::MatrixXd rest = front.matrix().bottomRightCorner(below, below);
      rebuilt.bottomRightCorner(below, below) += rest.selfadjointView<Eigen::Lower>();
      ASSERT_TRUE(rebuilt.isApprox(F, 1e-12)) << size << " columns, " << pivots << " pivots";
    }
  }
}

TEST(FrontalKernels, EliminationStopsAtAPivotThatIsTooSmall) {
  Eigen::MatrixXd F = Eigen::MatrixXd::Identity(7, 7);
  F(4, 4) = 1e-3;
  const std::vector<double> zero(7, 0.0);
  const std::vector<double> larger(7, 1e-3);
  Padded first(F);
  EXPECT_TRUE(EliminateColumns(first.data(), first.ld, 7, 7, zero.data()));
  Padded second(F);
  EXPECT_FALSE(EliminateColumns(second.data(), second.ld, 7, 7, larger.data()));
  Padded third(F);
  EXPECT_TRUE(EliminateColumns(third.data(), third.ld, 7, 4, larger.data()));
  F(2, 2) = std::nan("");
  Padded fourth(F);
  EXPECT_FALSE(EliminateColumns(fourth.data(), fourth.ld, 7, 7, zero.data()));
}

/// Runs each kernel on random numbers of this size, and returns all that it defines.
std::vector<double> RunKernels(const FrontalKernels& kernels, int size, int pivots, unsigned seed) {
  std::srand(seed);
  std::vector<double> results;
  const auto add = [&](const Eigen::MatrixXd& matrix) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      for (Eigen::Index i = 0; i < matrix.rows(); ++i) results.push_back(matrix(i, j));
    }
  };
  Padded a(Eigen::MatrixXd::Random(size, pivots), 3);
  Padded b(Eigen::MatrixXd::Random(pivots, size));
  Padded product(Eigen::MatrixXd::Random(size, size));
  kernels.multiply_add(product.data(), product.ld, a.data(), a.ld, {b.data(), 1, b.ld}, size, size,
                       pivots);
  add(product.matrix());
  kernels.multiply_subtract(product.data(), product.ld, a.data(), a.ld, {b.data(), 1, b.ld}, size,
                            size, pivots);
  add(product.matrix());

  const Eigen::MatrixXd root = Eigen::MatrixXd::Random(size, size + 2);
  Padded front(Eigen::MatrixXd(root * root.transpose() + Eigen::MatrixXd::Identity(size, size)));
  const std::vector<double> smallest(static_cast<std::size_t>(pivots), 0.0);
  EXPECT_TRUE(kernels.eliminate_columns(front.data(), front.ld, size, pivots, smallest.data()));
  add(front.matrix().triangularView<Eigen::Lower>());
  for (const int lanes : {1, kMostLanes}) {
    Eigen::MatrixXd x = Eigen::MatrixXd::Random(lanes, size);
    kernels.solve_forward(front.data(), front.ld, size, pivots, x.data(), lanes);
    add(x);
    kernels.solve_backward(front.data(), front.ld, size, pivots, x.data(), lanes);
    add(x);
  }
  return results;
}

TEST(FrontalKernels, HaveTheSameBitsWithAvx2AndWithout) {
  if (Avx2Kernels() == nullptr) GTEST_SKIP() << "this processor has no AVX2";
  unsigned seed = 0;
  for (int size = 1; size <= 40; size += size < 14 ? 1 : 7) {
    for (int pivots = 1; pivots <= size; pivots += size < 14 ? 1 : 5) {
      ++seed;
      EXPECT_EQ(RunKernels(BaselineKernels(), size, pivots, seed),
                RunKernels(*Avx2Kernels(), size, pivots, seed))
          << size << " columns, " << pivots << " pivots";
    }
  }
}

}  // namespace
}  // namespace loopgrid
