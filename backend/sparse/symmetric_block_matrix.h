#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace loopgrid {

/// Place of an off-diagonal block.
struct BlockPlace {
  int row;
  int col;
};

/// A sparse symmetric matrix of kDim x kDim blocks of which only the upper triangle is kept. The
/// blocks are stored in the order in which they were added, so the pattern can grow at any time
/// without moving what is there: the Hessian of a graph that grows. Scalar is double, or
/// DoubleDouble where that has too few digits.
template <int kDim, typename Scalar = double>
class SymmetricBlockMatrix {
 public:
  using Block = Eigen::Matrix<Scalar, kDim, kDim>;

  void Clear() {
    diagonal_.clear();
    places_.clear();
    values_.clear();
    lookup_.clear();
  }

  /// Appends zero rows and columns until there are `count` block columns.
  void Resize(int count) { diagonal_.resize(static_cast<std::size_t>(count), Block::Zero()); }

  /// Index of the off-diagonal block at (row, col), row < col; a new one starts at zero.
  int FindOrAddBlock(int row, int col) {
    const auto key = (static_cast<std::uint64_t>(row) << 32) | static_cast<std::uint32_t>(col);
    const auto [place, is_new] = lookup_.try_emplace(key, static_cast<int>(places_.size()));
    if (is_new) {
      places_.push_back({row, col});
      values_.push_back(Block::Zero());
    }
    return place->second;
  }

  void SetZero() {
    std::fill(diagonal_.begin(), diagonal_.end(), Block::Zero());
    std::fill(values_.begin(), values_.end(), Block::Zero());
  }

  int cols() const { return static_cast<int>(diagonal_.size()); }  ///< in blocks
  int block_count() const { return static_cast<int>(places_.size()); }
  /// row < col for each
  std::span<const BlockPlace> places() const { return places_; }

  /// The product with a vector.
  Eigen::VectorXd operator*(const Eigen::VectorXd& x) const {
    Eigen::VectorXd y(x.size());
    for (int k = 0; k < cols(); ++k) {
      y.segment<kDim>(kDim * k) = diagonal(k) * x.segment<kDim>(kDim * k);
    }
    for (int block = 0; block < block_count(); ++block) {
      const auto [row, col] = places_[static_cast<std::size_t>(block)];
      y.segment<kDim>(kDim * row) += off_diagonal(block) * x.segment<kDim>(kDim * col);
      y.segment<kDim>(kDim * col) += off_diagonal(block).transpose() * x.segment<kDim>(kDim * row);
    }
    return y;
  }

  Block& diagonal(int col) { return diagonal_[static_cast<std::size_t>(col)]; }
  const Block& diagonal(int col) const { return diagonal_[static_cast<std::size_t>(col)]; }
  Block& off_diagonal(int block) { return values_[static_cast<std::size_t>(block)]; }
  const Block& off_diagonal(int block) const { return values_[static_cast<std::size_t>(block)]; }

 private:
  std::vector<Block> diagonal_;
  std::vector<BlockPlace> places_;
  std::vector<Block> values_;
  std::unordered_map<std::uint64_t, int> lookup_;  // (row, col) -> index in places_
};

}  // namespace loopgrid
