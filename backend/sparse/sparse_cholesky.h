#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "backend/sparse/symbolic_factor.h"
#include "backend/sparse/symmetric_block_matrix.h"

namespace loopgrid {

/// Multifrontal Cholesky factorisation (Duff and Reid 1983; Liu 1992) of sparse symmetric positive
/// definite matrices of small dense blocks. Ordering, structure and memory are set up once per
/// pattern; after that only numbers are computed, in a fixed order. One thread may use an object at
/// a time.
template <int kDim>
class SparseCholesky {
 public:
  using Matrix = SymmetricBlockMatrix<kDim>;
  using Block = typename Matrix::Block;

  /// Orders the blocks (minimum degree, for large matrices nested dissection too) and finds the
  /// structure of the factor. For a matrix that has grown since the last call the order is kept,
  /// new columns last, while that costs little fill.
  void Analyze(const Matrix& H);

  /// Factorises H, plus a diagonal matrix if its entries are given. H must have the pattern that
  /// was analysed. False if the sum is not positive definite to working precision.
  [[nodiscard]] bool Factorize(const Matrix& H, const Eigen::VectorXd& added = {});

  /// H^-1 * rhs for one or more right-hand sides (columns), after a successful Factorize.
  Eigen::MatrixXd Solve(const Eigen::Ref<const Eigen::MatrixXd>& rhs) const;

  /// The factor's columns of a supernode, over the rows of its front; the leading dimension is
  /// PaddedRows of the front's size. Above the diagonal nothing is defined.
  const double* panel(int s) const { return values_.data() + panel_start_[Index(s)]; }

  const SymbolicFactor& structure() const { return structure_; }

 private:
  /// A block of H below the diagonal and where it goes in its supernode's front.
  struct Source {
    int block;
    int front_row;
    int front_col;
    bool transposed;
  };

  bool KeepOrder(const Matrix& H);
  void PlaceSources(const Matrix& H);
  void PlaceMemory();
  void Assemble(const Matrix& H, const Eigen::VectorXd& added, int s);
  void AddUpdates(int s);
  void SolveLanes(double* x, int lanes) const;

  int FrontSize(int s) const { return kDim * (structure_.columns(s) + structure_.row_count(s)); }
  static std::size_t Index(int i) { return static_cast<std::size_t>(i); }

  SymbolicFactor structure_;
  double ordered_fill_ = 0.0;    // entries of the factor per block of H when its order was found
  std::vector<Source> sources_;  // by supernode
  std::vector<std::size_t> first_source_;  // per supernode, and the end
  std::vector<int> first_child_;           // per supernode, the last in elimination order
  std::vector<int> sibling_;               // the one before it
  std::vector<std::size_t> panel_start_;   // of each supernode's columns in values_
  std::vector<double> values_;             // the factor
  std::vector<double> smallest_pivots_;    // a pivot below is rounding noise
  std::vector<double> front_;              // the one being eliminated
  std::vector<double> updates_;            // stack of Schur complements that wait for their parents
  std::vector<std::size_t> update_start_;
  mutable std::vector<double> solve_work_;  // the right-hand sides of one front
};

extern template class SparseCholesky<2>;
extern template class SparseCholesky<3>;
extern template class SparseCholesky<4>;
extern template class SparseCholesky<6>;

}  // namespace loopgrid
