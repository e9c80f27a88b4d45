#include "backend/sparse/symmetric_block_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "tests/support/block_matrices.h"

namespace loopgrid {
namespace {

TEST(SymmetricBlockMatrix, FindsTheBlocksItHasAndAddsOthersAtTheEnd) {
  SymmetricBlockMatrix<3> H;
  H.Resize(4);
  EXPECT_EQ(H.FindOrAddBlock(0, 3), 0);
  EXPECT_EQ(H.FindOrAddBlock(1, 2), 1);
  EXPECT_EQ(H.FindOrAddBlock(0, 3), 0);
  EXPECT_EQ(H.FindOrAddBlock(0, 2), 2);
  EXPECT_EQ(H.block_count(), 3);
  EXPECT_EQ(H.places()[1].row, 1);
  EXPECT_EQ(H.places()[1].col, 2);
}

TEST(SymmetricBlockMatrix, GrowingLeavesValuesWhereTheyAre) {
  SymmetricBlockMatrix<3> H;
  H.Resize(2);
  H.FindOrAddBlock(0, 1);
  H.diagonal(1).setConstant(5.0);
  H.off_diagonal(0).setConstant(6.0);
  H.Resize(3);
  H.FindOrAddBlock(1, 2);
  EXPECT_EQ(H.diagonal(1)(2, 0), 5.0);
  EXPECT_EQ(H.off_diagonal(0)(0, 2), 6.0);
  EXPECT_TRUE(H.diagonal(2).isZero(0.0));
  EXPECT_TRUE(H.off_diagonal(1).isZero(0.0));
  H.SetZero();
  EXPECT_TRUE(H.diagonal(1).isZero(0.0));
  EXPECT_TRUE(H.off_diagonal(0).isZero(0.0));
  EXPECT_EQ(H.block_count(), 2);
}

TEST(SymmetricBlockMatrix, ClearForgetsThePattern) {
  SymmetricBlockMatrix<3> H;
  H.Resize(3);
  H.FindOrAddBlock(0, 1);
  H.Clear();
  EXPECT_EQ(H.cols(), 0);
  EXPECT_EQ(H.block_count(), 0);
  H.Resize(3);
  EXPECT_EQ(H.FindOrAddBlock(1, 2), 0);
}

template <int kDim>
void ExpectProductsAreThoseOfTheDenseMatrix() {
  std::mt19937 random(1);
  for (int cols = 1; cols <= 20; ++cols) {
    const auto H = test_support::RandomBlockMatrix<kDim>(cols, 2 * cols, &random);
    const Eigen::VectorXd x = Eigen::VectorXd::Random(kDim * cols);
    EXPECT_TRUE((H * x).isApprox(test_support::Dense(H) * x, 1e-13)) << cols << " columns";
  }
}

TEST(SymmetricBlockMatrix, TimesAVectorIsThatOfTheDenseMatrix) {
  ExpectProductsAreThoseOfTheDenseMatrix<2>();
  ExpectProductsAreThoseOfTheDenseMatrix<3>();
  ExpectProductsAreThoseOfTheDenseMatrix<6>();
}

}  // namespace
}  // namespace loopgrid
