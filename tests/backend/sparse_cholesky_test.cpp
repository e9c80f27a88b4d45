#include "backend/sparse_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "backend/normal_equations.h"
#include "backend/selected_inverse.h"
#include "tests/support/block_matrices.h"
#include "tests/support/cholmod_solver.h"
#include "tests/support/graphs.h"

namespace loopgrid {
namespace {

using test_support::Dense;

TEST(SparseCholesky, SolvesAsTheDenseMatrixDoes) {
  std::mt19937 random(31);
  for (int cols = 1; cols <= 60; ++cols) {
    const SymmetricBlockMatrix<3> H = test_support::RandomBlockMatrix(cols, 2 * cols, &random);
    SparseCholesky<3> cholesky;
    cholesky.Analyze(H);
    ASSERT_TRUE(cholesky.Factorize(H));
    for (int count : {1, 3, 4, 6}) {  // right-hand sides
      const Eigen::MatrixXd rhs = Eigen::MatrixXd::Random(3 * cols, count);
      EXPECT_TRUE(cholesky.Solve(rhs).isApprox(Dense(H).llt().solve(rhs), 1e-10))
          << "seed 31, " << cols << " columns, " << count << " right-hand sides";
    }
  }
}

TEST(SparseCholesky, AddsToTheDiagonal) {
  std::mt19937 random(32);
  const SymmetricBlockMatrix<3> H = test_support::RandomBlockMatrix(20, 40, &random);
  const Eigen::VectorXd added = Eigen::VectorXd::LinSpaced(60, 0.0, 3.0);
  SparseCholesky<3> cholesky;
  cholesky.Analyze(H);
  ASSERT_TRUE(cholesky.Factorize(H, added));
  Eigen::MatrixXd sum = Dense(H);
  sum.diagonal() += added;
  const Eigen::VectorXd rhs = Eigen::VectorXd::Random(60);
  EXPECT_TRUE(cholesky.Solve(rhs).isApprox(sum.llt().solve(rhs), 1e-10));
}

TEST(SparseCholesky, ReusesItsAnalysisForNewValues) {
  std::mt19937 random(33);
  SymmetricBlockMatrix<3> H = test_support::RandomBlockMatrix(50, 120, &random);
  SparseCholesky<3> cholesky;
  cholesky.Analyze(H);
  const Eigen::VectorXd rhs = Eigen::VectorXd::Random(150);
  for (int round = 0; round < 5; ++round) {
    test_support::Randomize(&random, &H);
    ASSERT_TRUE(cholesky.Factorize(H));
    EXPECT_TRUE(cholesky.Solve(rhs).isApprox(Dense(H).llt().solve(rhs), 1e-10)) << round;
  }
}

TEST(SparseCholesky, KeepsUpWithAMatrixThatGrows) {
  std::mt19937 random(38);
  SymmetricBlockMatrix<3> H;
  SparseCholesky<3> cholesky;
  for (int cols = 1; cols <= 120; ++cols) {
    H.Resize(cols);
    if (cols > 1) H.FindOrAddBlock(cols - 2, cols - 1);
    if (cols > 2) {
      const int row = std::uniform_int_distribution<int>(0, cols - 3)(random);
      H.FindOrAddBlock(row, cols - 1);
    }
    test_support::Randomize(&random, &H);
    cholesky.Analyze(H);
    ASSERT_TRUE(cholesky.Factorize(H));
    const Eigen::VectorXd rhs = Eigen::VectorXd::Random(3 * cols);
    EXPECT_TRUE(cholesky.Solve(rhs).isApprox(Dense(H).llt().solve(rhs), 1e-10))
        << "seed 38, " << cols << " columns";
    SparseCholesky<3> fresh;
    fresh.Analyze(H);
    EXPECT_LE(cholesky.structure().entries, 2 * fresh.structure().entries) << "the order is stale";
  }
}

TEST(SparseCholesky, SaysWhenTheMatrixIsIndefinite) {
  std::mt19937 random(34);
  for (int col = 0; col < 30; ++col) {
    SymmetricBlockMatrix<3> H = test_support::RandomBlockMatrix(30, 60, &random);
    SparseCholesky<3> cholesky;
    cholesky.Analyze(H);
    ASSERT_TRUE(cholesky.Factorize(H));
    H.diagonal(col)(1, 1) = -1.0;
    EXPECT_FALSE(cholesky.Factorize(H));
    H.diagonal(col)(1, 1) = std::nan("");
    EXPECT_FALSE(cholesky.Factorize(H));
  }
}

TEST(SparseCholesky, SaysWhenTheMatrixIsSingular) {
  // No node held: the whole graph can move, so the Hessian has rank 3 (n - 1).
  const PoseGraph<SE2> graph = test_support::RandomGraph(40, 30, 35);
  SymmetricBlockMatrix<3> H;
  H.Resize(40);
  const Eigen::MatrixXd dense = test_support::DenseHessian(graph);
  for (int i = 0; i < 40; ++i) H.diagonal(i) = dense.block<3, 3>(3 * i, 3 * i);
  for (const Constraint<SE2>& constraint : graph.constraints) {
    const auto [row, col] = std::minmax({constraint.from, constraint.to});
    H.off_diagonal(H.FindOrAddBlock(row, col)) = dense.block<3, 3>(3 * row, 3 * col);
  }
  SparseCholesky<3> cholesky;
  cholesky.Analyze(H);
  EXPECT_FALSE(cholesky.Factorize(H));
  EXPECT_TRUE(cholesky.Factorize(H, 1e-6 * dense.diagonal()));
}

TEST(SparseCholesky, AgreesWithCholmodOnAPoseGraph) {
  const PoseGraph<SE2> graph = test_support::RandomGraph(700, 500, 36);
  NormalEquations<SE2> equations;
  equations.SetStructure(graph);
  equations.Linearize(graph, {});
  SparseCholesky<3> cholesky;
  cholesky.Analyze(equations.hessian());
  ASSERT_TRUE(cholesky.Factorize(equations.hessian()));
  test_support::CholmodSolver cholmod;
  cholmod.Analyze(equations.hessian());
  ASSERT_TRUE(cholmod.Factorize(equations.hessian()));
  EXPECT_TRUE(
      cholesky.Solve(equations.gradient()).isApprox(cholmod.Solve(equations.gradient()), 1e-9));
}

TEST(SparseCholesky, GivesTheSameBitsTwice) {
  const PoseGraph<SE2> graph = test_support::RandomGraph(300, 300, 37);
  Eigen::VectorXd solutions[2];
  for (Eigen::VectorXd& solution : solutions) {
    NormalEquations<SE2> equations;
    equations.SetStructure(graph);
    equations.Linearize(graph, {});
    SparseCholesky<3> cholesky;
    cholesky.Analyze(equations.hessian());
    ASSERT_TRUE(cholesky.Factorize(equations.hessian()));
    solution = cholesky.Solve(equations.gradient());
  }
  EXPECT_EQ(solutions[0], solutions[1]);
}

TEST(SparseCholesky, OfNothingIsNothing) {
  SparseCholesky<3> cholesky;
  const SymmetricBlockMatrix<3> H;
  cholesky.Analyze(H);
  EXPECT_TRUE(cholesky.Factorize(H));
  EXPECT_EQ(cholesky.Solve(Eigen::VectorXd()).size(), 0);
  EXPECT_TRUE(InverseDiagonal(cholesky).empty());
}

TEST(InverseDiagonal, AgreesWithDenseInverses) {
  std::mt19937 random(41);
  for (int cols = 1; cols <= 80; ++cols) {
    for (int blocks : {0, cols / 2, 2 * cols}) {
      const SymmetricBlockMatrix<3> H = test_support::RandomBlockMatrix(cols, blocks, &random);
      SparseCholesky<3> cholesky;
      cholesky.Analyze(H);
      ASSERT_TRUE(cholesky.Factorize(H));
      const Eigen::MatrixXd inverse = Dense(H).inverse();
      const auto diagonal = InverseDiagonal(cholesky);
      ASSERT_EQ(static_cast<int>(diagonal.size()), cols);
      for (int i = 0; i < cols; ++i) {
        const Eigen::Matrix3d expected = inverse.block<3, 3>(3 * i, 3 * i);
        EXPECT_TRUE(diagonal[static_cast<std::size_t>(i)].isApprox(expected, 1e-10))
            << "seed 41, " << cols << " columns, " << blocks << " blocks";
      }
    }
  }
}

}  // namespace
}  // namespace loopgrid
