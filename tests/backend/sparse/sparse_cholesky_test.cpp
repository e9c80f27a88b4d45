#include "backend/sparse/sparse_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <type_traits>

#include "backend/solve/normal_equations.h"
#include "backend/sparse/selected_inverse.h"
#include "tests/support/block_matrices.h"
#include "tests/support/cholmod_solver.h"
#include "tests/support/graphs.h"

namespace loopgrid {
namespace {

using test_support::CholmodSolver;
using test_support::Dense;
using test_support::RandomBlockMatrix;
using test_support::RandomGraph;

template <typename Dim>
class SparseCholeskyTest : public ::testing::Test {
 protected:
  using Matrix = SymmetricBlockMatrix<Dim::value>;
  using Cholesky = SparseCholesky<Dim::value>;

  std::mt19937 random_{31};
};

struct DimName {
  template <typename Dim>
  static std::string GetName(int) {
    return "Blocks" + std::to_string(Dim::value);
  }
};

using AllDims = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                 std::integral_constant<int, 6>>;
TYPED_TEST_SUITE(SparseCholeskyTest, AllDims, DimName);

TYPED_TEST(SparseCholeskyTest, SolvesAsTheDenseMatrixDoes) {
  for (int cols = 1; cols <= 40; ++cols) {
    const auto H = RandomBlockMatrix<TypeParam::value>(cols, 2 * cols, &this->random_);
    typename TestFixture::Cholesky cholesky;
    cholesky.Analyze(H);
    ASSERT_TRUE(cholesky.Factorize(H));
    for (int count : {1, 3, 4, 6}) {  // right-hand sides
      const Eigen::MatrixXd rhs = Eigen::MatrixXd::Random(TypeParam::value * cols, count);
      EXPECT_TRUE(cholesky.Solve(rhs).isApprox(Dense(H).llt().solve(rhs), 1e-10))
          << cols << " columns, " << count << " right-hand sides";
    }
  }
}

TYPED_TEST(SparseCholeskyTest, AddsToTheDiagonal) {
  const auto H = RandomBlockMatrix<TypeParam::value>(20, 40, &this->random_);
  const Eigen::Index size = 20 * TypeParam::value;
  const Eigen::VectorXd added = Eigen::VectorXd::LinSpaced(size, 0.0, 3.0);
  typename TestFixture::Cholesky cholesky;
  cholesky.Analyze(H);
  ASSERT_TRUE(cholesky.Factorize(H, added));
  Eigen::MatrixXd sum = Dense(H);
  sum.diagonal() += added;
  const Eigen::VectorXd rhs = Eigen::VectorXd::Random(size);
  EXPECT_TRUE(cholesky.Solve(rhs).isApprox(sum.llt().solve(rhs), 1e-10));
}

TYPED_TEST(SparseCholeskyTest, ReusesItsAnalysisForNewValues) {
  auto H = RandomBlockMatrix<TypeParam::value>(50, 120, &this->random_);
  typename TestFixture::Cholesky cholesky;
  cholesky.Analyze(H);
  const Eigen::VectorXd rhs = Eigen::VectorXd::Random(50 * TypeParam::value);
  for (int round = 0; round < 5; ++round) {
    test_support::Randomize(&this->random_, &H);
    ASSERT_TRUE(cholesky.Factorize(H));
    EXPECT_TRUE(cholesky.Solve(rhs).isApprox(Dense(H).llt().solve(rhs), 1e-10)) << round;
  }
}

TYPED_TEST(SparseCholeskyTest, KeepsUpWithAMatrixThatGrows) {
  typename TestFixture::Matrix H;
  typename TestFixture::Cholesky cholesky;
  for (int cols = 1; cols <= 80; ++cols) {
    H.Resize(cols);
    if (cols > 1) H.FindOrAddBlock(cols - 2, cols - 1);
    if (cols > 2) {
      const int row = std::uniform_int_distribution<int>(0, cols - 3)(this->random_);
      H.FindOrAddBlock(row, cols - 1);
    }
    test_support::Randomize(&this->random_, &H);
    cholesky.Analyze(H);
    ASSERT_TRUE(cholesky.Factorize(H));
    const Eigen::VectorXd rhs = Eigen::VectorXd::Random(TypeParam::value * cols);
    EXPECT_TRUE(cholesky.Solve(rhs).isApprox(Dense(H).llt().solve(rhs), 1e-10))
        << cols << " columns";
    typename TestFixture::Cholesky fresh;
    fresh.Analyze(H);
    EXPECT_LE(cholesky.structure().entries, 2 * fresh.structure().entries) << "the order is stale";
  }
}

TYPED_TEST(SparseCholeskyTest, TakesAnyMatrixAfterAnyOther) {
  typename TestFixture::Cholesky cholesky;
  for (int cols : {30, 10, 50, 0, 20, 1, 40}) {
    const auto H = RandomBlockMatrix<TypeParam::value>(cols + 1, 2 * cols, &this->random_);
    cholesky.Analyze(H);
    ASSERT_TRUE(cholesky.Factorize(H));
    const Eigen::VectorXd rhs = Eigen::VectorXd::Random(TypeParam::value * (cols + 1));
    EXPECT_TRUE(cholesky.Solve(rhs).isApprox(Dense(H).llt().solve(rhs), 1e-10)) << cols;
  }
}

TYPED_TEST(SparseCholeskyTest, SaysWhenTheMatrixIsIndefinite) {
  for (int col = 0; col < 30; ++col) {
    auto H = RandomBlockMatrix<TypeParam::value>(30, 60, &this->random_);
    typename TestFixture::Cholesky cholesky;
    cholesky.Analyze(H);
    ASSERT_TRUE(cholesky.Factorize(H));
    H.diagonal(col)(1, 1) = -1.0;
    EXPECT_FALSE(cholesky.Factorize(H));
    H.diagonal(col)(1, 1) = std::nan("");
    EXPECT_FALSE(cholesky.Factorize(H));
  }
}

TYPED_TEST(SparseCholeskyTest, AgreesWithCholmodOnALargeGrid) {
  constexpr int kDim = TypeParam::value;
  constexpr int kSide = 60;  // large enough for nested dissection
  typename TestFixture::Matrix H;
  H.Resize(kSide * kSide);
  for (int i = 0; i < kSide * kSide; ++i) {
    if (i % kSide + 1 < kSide) H.FindOrAddBlock(i, i + 1);
    if (i + kSide < kSide * kSide) H.FindOrAddBlock(i, i + kSide);
  }
  test_support::Randomize(&this->random_, &H);
  typename TestFixture::Cholesky cholesky;
  cholesky.Analyze(H);
  ASSERT_TRUE(cholesky.Factorize(H));
  CholmodSolver<kDim> cholmod;
  cholmod.Analyze(H);
  ASSERT_TRUE(cholmod.Factorize(H));
  const Eigen::VectorXd rhs = Eigen::VectorXd::Random(kDim * kSide * kSide);
  const Eigen::VectorXd x = cholesky.Solve(rhs);
  EXPECT_TRUE(x.isApprox(cholmod.Solve(rhs), 1e-11));
  EXPECT_TRUE((H * x).isApprox(rhs, 1e-11));
}

TYPED_TEST(SparseCholeskyTest, OfNothingIsNothing) {
  typename TestFixture::Cholesky cholesky;
  const typename TestFixture::Matrix H;
  cholesky.Analyze(H);
  EXPECT_TRUE(cholesky.Factorize(H));
  EXPECT_EQ(cholesky.Solve(Eigen::VectorXd()).size(), 0);
}

template <typename Pose>
class PoseGraphCholeskyTest : public ::testing::Test {};

TYPED_TEST_SUITE(PoseGraphCholeskyTest, test_support::AllPoses, test_support::PoseName);

TYPED_TEST(PoseGraphCholeskyTest, SaysWhenTheMatrixIsSingular) {
  // No node held: the whole graph can move.
  constexpr int kDim = TypeParam::kDof;
  const auto graph = RandomGraph<TypeParam>(40, 30, 35);
  SymmetricBlockMatrix<kDim> H;
  H.Resize(40);
  const Eigen::MatrixXd dense = test_support::DenseHessian(graph);
  for (int i = 0; i < 40; ++i) H.diagonal(i) = dense.block<kDim, kDim>(kDim * i, kDim * i);
  for (const Constraint<TypeParam>& constraint : graph.constraints) {
    const auto [row, col] = std::minmax({constraint.from, constraint.to});
    H.off_diagonal(H.FindOrAddBlock(row, col)) = dense.block<kDim, kDim>(kDim * row, kDim * col);
  }
  SparseCholesky<kDim> cholesky;
  cholesky.Analyze(H);
  EXPECT_FALSE(cholesky.Factorize(H));
  EXPECT_TRUE(cholesky.Factorize(H, 1e-6 * dense.diagonal()));
}

TYPED_TEST(PoseGraphCholeskyTest, AgreesWithCholmod) {
  const auto graph = RandomGraph<TypeParam>(500, 150, 36, 60);
  NormalEquations<TypeParam> equations;
  equations.SetStructure(graph);
  equations.Linearize(graph, {});
  SparseCholesky<TypeParam::kDof> cholesky;
  cholesky.Analyze(equations.hessian());
  ASSERT_TRUE(cholesky.Factorize(equations.hessian()));
  CholmodSolver<TypeParam::kDof> cholmod;
  cholmod.Analyze(equations.hessian());
  ASSERT_TRUE(cholmod.Factorize(equations.hessian()));
  const Eigen::VectorXd x = cholesky.Solve(equations.gradient());
  // Long chains are badly conditioned: residuals are small, solutions have fewer digits.
  EXPECT_TRUE((equations.hessian() * x).isApprox(equations.gradient(), 1e-9));
  EXPECT_TRUE(x.isApprox(cholmod.Solve(equations.gradient()), 1e-7));
}

// Memory that another factorisation has left behind must not show.
TYPED_TEST(PoseGraphCholeskyTest, HasTheSameBitsWhateverCameBefore) {
  const auto graph = RandomGraph<TypeParam>(300, 150, 37);
  NormalEquations<TypeParam> equations;
  equations.SetStructure(graph);
  equations.Linearize(graph, {});
  const auto& H = equations.hessian();
  SparseCholesky<TypeParam::kDof> fresh;
  fresh.Analyze(H);
  ASSERT_TRUE(fresh.Factorize(H));
  const Eigen::VectorXd expected = fresh.Solve(equations.gradient());

  std::mt19937 random(37);
  const auto larger = RandomBlockMatrix<TypeParam::kDof>(500, 900, &random);
  SparseCholesky<TypeParam::kDof> used;
  used.Analyze(larger);
  ASSERT_TRUE(used.Factorize(larger));
  const auto nothing = RandomBlockMatrix<TypeParam::kDof>(1, 0, &random);
  used.Analyze(nothing);  // so that no order is kept
  used.Analyze(H);
  auto broken = H;
  broken.diagonal(150).setConstant(std::nan(""));
  EXPECT_FALSE(used.Factorize(broken));
  ASSERT_TRUE(used.Factorize(H));
  EXPECT_EQ(used.smallest_pivot(), fresh.smallest_pivot());
  EXPECT_EQ(used.structure().order, fresh.structure().order);
  EXPECT_EQ(used.Solve(equations.gradient()), expected);
}

/// A matrix and the same with twice the digits.
template <int kDim>
SymmetricBlockMatrix<kDim, DoubleDouble> Exact(const SymmetricBlockMatrix<kDim>& H) {
  SymmetricBlockMatrix<kDim, DoubleDouble> exact;
  exact.Resize(H.cols());
  for (int i = 0; i < H.cols(); ++i)
    exact.diagonal(i) = H.diagonal(i).template cast<DoubleDouble>();
  for (int k = 0; k < H.block_count(); ++k) {
    const BlockPlace place = H.places()[static_cast<std::size_t>(k)];
    exact.off_diagonal(exact.FindOrAddBlock(place.row, place.col)) =
        H.off_diagonal(k).template cast<DoubleDouble>();
  }
  return exact;
}

TYPED_TEST(SparseCholeskyTest, SolvesWithTwiceTheDigits) {
  for (int cols = 1; cols <= 40; cols += 3) {
    const auto H = RandomBlockMatrix<TypeParam::value>(cols, 2 * cols, &this->random_);
    const Eigen::Index size = TypeParam::value * cols;
    const Eigen::VectorXd added = Eigen::VectorXd::LinSpaced(size, 0.0, 3.0);
    typename TestFixture::Cholesky cholesky;
    cholesky.Analyze(H);
    ASSERT_EQ(cholesky.FactorizeExactly(Exact(H), added), Definiteness::kDefinite);
    Eigen::MatrixXd sum = Dense(H);
    sum.diagonal() += added;
    const Eigen::MatrixXd rhs = Eigen::MatrixXd::Random(size, 3);
    EXPECT_TRUE(cholesky.Solve(rhs).isApprox(sum.llt().solve(rhs), 1e-10)) << cols << " columns";
  }
}

TYPED_TEST(SparseCholeskyTest, HoldsAVariableOfEachFreeDirection) {
  constexpr int kDim = TypeParam::value;
  // J^T J with fewer rows than columns, in one dense matrix of blocks.
  constexpr int kCols = 6;
  typename TestFixture::Matrix H;
  H.Resize(kCols);
  const Eigen::MatrixXd J =
      (100.0 * Eigen::MatrixXd::Random(kDim * kCols - 3, kDim * kCols)).array().round();
  const Eigen::MatrixXd dense = J.transpose() * J;  // of integers: exact
  for (int i = 0; i < kCols; ++i) {
    H.diagonal(i) = dense.block<kDim, kDim>(kDim * i, kDim * i);
    for (int j = i + 1; j < kCols; ++j) {
      H.off_diagonal(H.FindOrAddBlock(i, j)) = dense.block<kDim, kDim>(kDim * i, kDim * j);
    }
  }
  typename TestFixture::Cholesky cholesky;
  cholesky.Analyze(H);
  EXPECT_FALSE(cholesky.Factorize(H));
  EXPECT_EQ(cholesky.FactorizeExactly(Exact(H)), Definiteness::kSemidefinite);
  const Eigen::VectorXd rhs = dense * Eigen::VectorXd::Random(dense.rows());
  const Eigen::VectorXd x = cholesky.Solve(rhs);
  EXPECT_TRUE((dense * x).isApprox(rhs, 1e-6));
  EXPECT_EQ((x.array() == 0.0).count(), 3);
  EXPECT_EQ(cholesky.FreeDirections(2).cols(), 0);
  const Eigen::MatrixXd free = cholesky.FreeDirections(3);
  ASSERT_EQ(free.cols(), 3);
  EXPECT_EQ(Eigen::FullPivLU<Eigen::MatrixXd>(free).rank(), 3);
  EXPECT_LE((J * free).norm(), 1e-9 * J.norm() * free.norm());
  EXPECT_EQ(cholesky.Solve(rhs), x);  // as before
  H.diagonal(2)(1, 1) -= 1e5;
  EXPECT_EQ(cholesky.FactorizeExactly(Exact(H)), Definiteness::kIndefinite);
}

TYPED_TEST(SparseCholeskyTest, TellsTheSmallestPivot) {
  constexpr int kDim = TypeParam::value;
  typename TestFixture::Matrix H;
  H.Resize(2);
  H.diagonal(0).setIdentity();
  H.diagonal(1) = 4.0 * Eigen::Matrix<double, kDim, kDim>::Identity();
  H.off_diagonal(H.FindOrAddBlock(0, 1))(1, 1) = 1.6;  // leaves 0.36 of either diagonal entry
  typename TestFixture::Cholesky cholesky;
  cholesky.Analyze(H);
  ASSERT_TRUE(cholesky.Factorize(H));
  EXPECT_NEAR(cholesky.smallest_pivot(), 0.36, 1e-12);
}

TYPED_TEST(PoseGraphCholeskyTest, InverseDiagonalAgreesWithDenseInverses) {
  constexpr int kDim = TypeParam::kDof;
  std::mt19937 random(41);
  for (int cols = 1; cols <= 60; cols += kDim / 3) {
    for (int blocks : {0, cols / 2, 2 * cols}) {
      const auto H = RandomBlockMatrix<kDim>(cols, blocks, &random);
      SparseCholesky<kDim> cholesky;
      cholesky.Analyze(H);
      ASSERT_TRUE(cholesky.Factorize(H));
      const Eigen::MatrixXd inverse = Dense(H).inverse();
      const auto diagonal = InverseDiagonal(cholesky);
      ASSERT_EQ(static_cast<int>(diagonal.size()), cols);
      for (int i = 0; i < cols; ++i) {
        const Eigen::MatrixXd expected = inverse.block<kDim, kDim>(kDim * i, kDim * i);
        EXPECT_TRUE(diagonal[static_cast<std::size_t>(i)].isApprox(expected, 1e-10))
            << "seed 41, " << cols << " columns, " << blocks << " blocks";
      }
    }
  }
  SparseCholesky<kDim> nothing;
  nothing.Analyze({});
  ASSERT_TRUE(nothing.Factorize({}));
  EXPECT_TRUE(InverseDiagonal(nothing).empty());
}

}  // namespace
}  // namespace loopgrid
