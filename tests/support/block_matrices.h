#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <random>

#include "backend/sparse/symmetric_block_matrix.h"

namespace loopgrid::test_support {

/// A block matrix as a dense matrix.
template <int kDim>
Eigen::MatrixXd Dense(const SymmetricBlockMatrix<kDim>& H) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(kDim * H.cols(), kDim * H.cols());
  for (int i = 0; i < H.cols(); ++i) {
    dense.template block<kDim, kDim>(kDim * i, kDim * i) = H.diagonal(i);
  }
  for (int k = 0; k < H.block_count(); ++k) {
    const BlockPlace place = H.places()[static_cast<std::size_t>(k)];
    dense.template block<kDim, kDim>(kDim * place.row, kDim * place.col) = H.off_diagonal(k);
    dense.template block<kDim, kDim>(kDim * place.col, kDim * place.row) =
        H.off_diagonal(k).transpose();
  }
  return dense;
}

/// Sets random values. The diagonal dominates, so the matrix is positive definite.
template <int kDim>
void Randomize(std::mt19937* random, SymmetricBlockMatrix<kDim>* H) {
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  using Block = typename SymmetricBlockMatrix<kDim>::Block;
  H->SetZero();
  for (int k = 0; k < H->block_count(); ++k) {
    const BlockPlace place = H->places()[static_cast<std::size_t>(k)];
    Block& block = H->off_diagonal(k);
    for (int i = 0; i < block.size(); ++i) block(i) = value(*random);
    H->diagonal(place.row) += kDim * Block::Identity();
    H->diagonal(place.col) += kDim * Block::Identity();
  }
  for (int i = 0; i < H->cols(); ++i) {
    Block root;
    for (int k = 0; k < root.size(); ++k) root(k) = value(*random);
    H->diagonal(i) += root * root.transpose() + 0.1 * Block::Identity();
  }
}

/// A matrix of `cols` block columns with about `blocks` random off-diagonal blocks.
template <int kDim>
SymmetricBlockMatrix<kDim> RandomBlockMatrix(int cols, int blocks, std::mt19937* random) {
  SymmetricBlockMatrix<kDim> H;
  H.Resize(cols);
  std::uniform_int_distribution<int> any(0, cols - 1);
  for (int k = 0; k < blocks; ++k) {
    const int a = any(*random);
    const int b = any(*random);
    if (a != b) H.FindOrAddBlock(std::min(a, b), std::max(a, b));
  }
  Randomize(random, &H);
  return H;
}

}  // namespace loopgrid::test_support
