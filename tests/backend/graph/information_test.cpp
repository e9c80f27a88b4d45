#include "backend/graph/information.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "tests/support/graphs.h"

namespace loopgrid {
namespace {

template <typename Size>
class InformationMatrixTest : public ::testing::Test {
 protected:
  static constexpr int kSize = Size::value;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  using Vector = Eigen::Matrix<double, kSize, 1>;

  /// A symmetric matrix with these eigenvalues.
  static Matrix WithEigenvalues(const Vector& values, std::mt19937* random) {
    const Matrix symmetric = test_support::RandomInformation<kSize>(random);
    const Matrix V = Eigen::SelfAdjointEigenSolver<Matrix>(symmetric).eigenvectors();
    const Matrix matrix = V * values.asDiagonal() * V.transpose();
    return 0.5 * (matrix + matrix.transpose());
  }
};

using InformationSizes =
    ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                     std::integral_constant<int, 6>>;
TYPED_TEST_SUITE(InformationMatrixTest, InformationSizes);

TYPED_TEST(InformationMatrixTest, ANegativeEigenvalueIsFoundAtAnyScale) {
  std::mt19937 random(5);
  for (double scale : {1e-200, 1.0, 1e200}) {
    for (double smallest : {-1e-8, -0.5, -7.0}) {
      typename TestFixture::Vector values = scale * TestFixture::Vector::LinSpaced(1.0, 2.0);
      values[0] = scale * smallest;
      const auto matrix = this->WithEigenvalues(values, &random);
      const auto found = NegativeEigenvalue(matrix);
      ASSERT_TRUE(found.has_value()) << scale << " " << smallest;
      EXPECT_NEAR(*found / scale, smallest, 1e-13);
    }
  }
}

TYPED_TEST(InformationMatrixTest, RoundingIsNoNegativeEigenvalue) {
  std::mt19937 random(6);
  for (double smallest : {-5e-10, -1e-16, 0.0, 1e-16, 0.1}) {
    typename TestFixture::Vector values = TestFixture::Vector::LinSpaced(0.5, 1.0);
    values[0] = smallest;
    EXPECT_FALSE(NegativeEigenvalue(this->WithEigenvalues(values, &random))) << smallest;
  }
  EXPECT_FALSE(NegativeEigenvalue(TestFixture::Matrix::Zero().eval()));
}

TYPED_TEST(InformationMatrixTest, TheNearestSemidefiniteMatrixHasTheOtherEigenvalues) {
  std::mt19937 random(7);
  typename TestFixture::Vector values = TestFixture::Vector::LinSpaced(-2.0, 3.0);
  const auto matrix = this->WithEigenvalues(values, &random);
  const auto nearest = NearestSemidefinite(matrix);
  EXPECT_EQ(nearest, nearest.transpose());
  const Eigen::SelfAdjointEigenSolver<typename TestFixture::Matrix> solver(nearest);
  EXPECT_LT((solver.eigenvalues() - values.cwiseMax(0.0)).norm(), 1e-13);
  EXPECT_EQ(NearestSemidefinite(nearest), nearest);
  // Nearer than others: a step towards any other semi-definite matrix leads away.
  for (int round = 0; round < 20; ++round) {
    const auto other = test_support::RandomInformation<TestFixture::kSize>(&random);
    const typename TestFixture::Matrix between = nearest + 1e-3 * (other - nearest);
    EXPECT_GT((between - matrix).norm(), (nearest - matrix).norm()) << "round " << round;
  }
}

TYPED_TEST(InformationMatrixTest, SoundMatricesStayAsTheyAre) {
  std::mt19937 random(8);
  for (int round = 0; round < 20; ++round) {
    const auto matrix = test_support::RandomInformation<TestFixture::kSize>(&random);
    EXPECT_EQ(NearestSemidefinite(matrix), matrix) << "round " << round;
  }
  const auto ones = TestFixture::Matrix::Ones().eval();
  EXPECT_EQ(NearestSemidefinite(ones), ones);
}

TEST(FindAsymmetry, NamesTheFirstEntryThatDiffers) {
  Eigen::Matrix3d matrix = Eigen::Vector3d(1.0, 2.0, 4.0).asDiagonal();
  EXPECT_FALSE(FindAsymmetry(matrix));
  matrix(2, 1) = 1e-9;  // rounding, against 4
  EXPECT_FALSE(FindAsymmetry(matrix));
  matrix(2, 1) = 1e-8;
  const auto found = FindAsymmetry(matrix);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->row, 1);
  EXPECT_EQ(found->column, 2);
}

}  // namespace
}  // namespace loopgrid
