#pragma once

#include <Eigen/Core>
#include <memory>

#include "backend/sparse/symmetric_block_matrix.h"

namespace loopgrid::test_support {

/// The solver that SparseCholesky is compared with: CHOLMOD's simplicial factorisation, ordered by
/// minimum degree on the blocks. On graphs of planar SLAM it is faster than CHOLMOD's supernodal
/// factorisation.
template <int kDim>
class CholmodSolver {
 public:
  CholmodSolver();
  ~CholmodSolver();
  CholmodSolver(CholmodSolver&&) noexcept;
  CholmodSolver& operator=(CholmodSolver&&) noexcept;

  /// Finds a fill-reducing ordering of the blocks and the structure of the factor.
  void Analyze(const SymmetricBlockMatrix<kDim>& H);

  /// Factorises H, which must have the pattern that was analysed. False if the
  /// matrix is not positive definite to working precision.
  [[nodiscard]] bool Factorize(const SymmetricBlockMatrix<kDim>& H);

  /// H^-1 * rhs for one or more right-hand sides (columns), after a successful Factorize.
  Eigen::MatrixXd Solve(const Eigen::Ref<const Eigen::MatrixXd>& rhs) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

extern template class CholmodSolver<2>;
extern template class CholmodSolver<3>;
extern template class CholmodSolver<6>;

}  // namespace loopgrid::test_support
