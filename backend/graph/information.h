#pragma once

#include <Eigen/Core>
#include <optional>

namespace loopgrid {

/// An information matrix has to be symmetric and positive semi-definite. Both are judged up to this
/// share of its largest eigenvalue or entry. A matrix of lower rank that has been computed (turned
/// into another frame, multiplied by Jacobians, inverted) or written with ten digits is off by less
/// than that. A larger share would hide real negative eigenvalues: metres and radians are mixed, so
/// that the eigenvalues of a sound matrix may already lie a factor of 1e6 apart.
inline constexpr double kInformationRounding = 1e-9;

/// The smallest eigenvalue of a finite symmetric matrix if it is negative by more than rounding.
template <int kSize>
std::optional<double> NegativeEigenvalue(const Eigen::Matrix<double, kSize, kSize>& information);

/// The positive semi-definite matrix that is nearest to a finite symmetric one in the Frobenius
/// norm: negative eigenvalues are replaced by zero (Higham, Linear Algebra Appl. 103, 1988). The
/// matrix itself if its eigenvalues are not negative by more than the rounding of this computation.
/// Not finite if the entries come close to the largest double.
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
