#include "backend/graph/information.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace loopgrid {
namespace {

/// Eigenvalues of symmetric matrices of this size are computed to a few units of 1e-16 of the
/// largest; and so is a matrix that is put together again from its eigenvalues.
constexpr double kEigenvalueRounding = 1e-13;

/// Below this, entries are so near to the smallest doubles that products with eigenvectors lose
/// digits.
constexpr double kNegligible = 1e-290;

/// Whether the matrix certainly is positive definite; far faster than eigenvalues.
template <int kSize>
bool HasCholeskyFactor(const Eigen::Matrix<double, kSize, kSize>& matrix) {
  const Eigen::LLT<Eigen::Matrix<double, kSize, kSize>> factor(matrix);
  return factor.info() == Eigen::Success && factor.matrixLLT().allFinite();
}

}  // namespace

template <int kSize>
std::optional<double> NegativeEigenvalue(const Eigen::Matrix<double, kSize, kSize>& information) {
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  if (HasCholeskyFactor(information)) return std::nullopt;
  const double scale = information.cwiseAbs().maxCoeff();
  if (scale == 0.0) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(information / scale, Eigen::EigenvaluesOnly);
  const auto& values = solver.eigenvalues();  // ascending
  const double largest = values.cwiseAbs().maxCoeff();
  if (values[0] >= -kInformationRounding * largest) return std::nullopt;
  return scale * values[0];
}

template <int kSize>
Eigen::Matrix<double, kSize, kSize> NearestSemidefinite(
    const Eigen::Matrix<double, kSize, kSize>& information) {
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  if (HasCholeskyFactor(information)) return information;
  const double scale = information.cwiseAbs().maxCoeff();
  if (scale == 0.0) return information;
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(information / scale);
  const auto& values = solver.eigenvalues();
  if (values[0] >= -kEigenvalueRounding * values.cwiseAbs().maxCoeff()) return information;
  if (scale < kNegligible) return Matrix::Zero();
  const Matrix& V = solver.eigenvectors();
  const Matrix product = V * values.cwiseMax(0.0).asDiagonal() * V.transpose();
  return scale * (0.5 * (product + product.transpose()));
}

template <int kSize>
std::optional<AsymmetricEntry> FindAsymmetry(
    const Eigen::Matrix<double, kSize, kSize>& information) {
  const double allowed = kInformationRounding * information.cwiseAbs().maxCoeff();
  for (int row = 0; row < kSize; ++row) {
    for (int column = row + 1; column < kSize; ++column) {
      if (!(std::abs(information(row, column) - information(column, row)) <= allowed)) {
        return AsymmetricEntry{row, column};
      }
    }
  }
  return std::nullopt;
}

#define LOOPGRID_INSTANTIATE(kSize)                                                              \
  template std::optional<double> NegativeEigenvalue(const Eigen::Matrix<double, kSize, kSize>&); \
  template Eigen::Matrix<double, kSize, kSize> NearestSemidefinite(                              \
      const Eigen::Matrix<double, kSize, kSize>&);                                               \
  template std::optional<AsymmetricEntry> FindAsymmetry(const Eigen::Matrix<double, kSize, kSize>&);
LOOPGRID_INSTANTIATE(2)
LOOPGRID_INSTANTIATE(3)
LOOPGRID_INSTANTIATE(6)
#undef LOOPGRID_INSTANTIATE

}  // namespace loopgrid
