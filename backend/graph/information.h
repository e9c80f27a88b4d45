#pragma once

#include <Eigen/Core>
#include <optional>

namespace loopgrid {

/// An information matrix has to be symmetric and positive semi-definite, up to this share of its
/// largest eigenvalue or entry. The rounding errors of a singular matrix that was computed (rotated
/// into another frame, multiplied by Jacobians, inverted) or written with ten digits are smaller
/// than that. A larger share would hide real negative eigenvalues, because the eigenvalues of a
/// sound matrix may differ by a factor of 1e6: it mixes metres and radians.
inline constexpr double kInformationRounding = 1e-9;

/// The smallest eigenvalue of a finite symmetric matrix if it is negative by more than rounding.
template <int kSize>
std::optional<double> NegativeEigenvalue(const Eigen::Matrix<double, kSize, kSize>& information);

/// The positive semi-definite matrix that is nearest to a finite symmetric one in the Frobenius
/// norm: negative eigenvalues are replaced by zero (Higham, Linear Algebra Appl. 103, 1988).
/// Returns the matrix itself if no eigenvalue is more negative than the rounding of this
/// computation. The result is not finite if the entries come close to the largest double.
template <int kSize>
Eigen::Matrix<double, kSize, kSize> NearestSemidefinite(
    const Eigen::Matrix<double, kSize, kSize>& information);

/// An entry that differs from its mirror image.
struct AsymmetricEntry {
  int row = 0;
  int column = 0;
};

/// The first entry above the diagonal that differs by more than rounding from the one below it.
template <int kSize>
std::optional<AsymmetricEntry> FindAsymmetry(
    const Eigen::Matrix<double, kSize, kSize>& information);

}  // namespace loopgrid
