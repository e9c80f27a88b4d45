#pragma once

#include <vector>

#include "backend/sparse/sparse_cholesky.h"

namespace loopgrid {

/// The diagonal blocks of H^-1, given its factor, without computing the rest of it: selected
/// inversion (Takahashi et al. 1973; Erisman and Tinney 1975), front by front from the root down.
template <int kDim>
std::vector<Eigen::Matrix<double, kDim, kDim>> InverseDiagonal(const SparseCholesky<kDim>& factor);

extern template std::vector<Eigen::Matrix3d> InverseDiagonal(const SparseCholesky<3>& factor);
extern template std::vector<Eigen::Matrix<double, 6, 6>> InverseDiagonal(
    const SparseCholesky<6>& factor);

}  // namespace loopgrid
