#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "backend/sparse/double_double.h"
#include "backend/sparse/exact_elimination.h"
#include "backend/sparse/front_plan.h"
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
  using ExactMatrix = SymmetricBlockMatrix<kDim, DoubleDouble>;

  /// Plans the factorisation of matrices with the pattern of H (see FrontPlan).
  void Analyze(const Matrix& H);

  /// Factorises H, plus a diagonal matrix if its entries are given. H must have the pattern that
  /// was analysed. Returns false, without a factor, if the sum is not positive definite, or so
  /// close to singular that some pivot is mostly rounding errors.
  [[nodiscard]] bool Factorize(const Matrix& H, const Eigen::VectorXd& added = {});

  /// The same with twice the digits, some 20 times slower. If H = J^T Omega J was summed up with as
  /// many digits, the factor is as exact as that of an orthogonal factorisation of J. There is a
  /// factor for a positive semidefinite sum, too: for each direction that the sum maps to zero, it
  /// holds one variable. Solve then gives a solution, if there is one, with zeros at these
  /// variables.
  [[nodiscard]] Definiteness FactorizeExactly(const ExactMatrix& H,
                                              const Eigen::VectorXd& added = {});

  /// A solution v of H v = 0 (a column) for each direction that FactorizeExactly has found free: 1
  /// at the variable that is held for it, 0 at those held for the others. No columns if there are
  /// none, or more than `most`.
  Eigen::MatrixXd FreeDirections(int most);

  /// H^-1 * rhs for one or more right-hand sides (columns), after a successful Factorize.
  Eigen::MatrixXd Solve(const Eigen::Ref<const Eigen::MatrixXd>& rhs) const;

  /// The smallest ratio of a pivot to the matrix's diagonal entry in its place. If the diagonal is
  /// scaled to 1, the condition number of the matrix is at least one over this.
  double smallest_pivot() const { return smallest_pivot_; }

  /// A bound on the relative error of the pivots, if the matrix's entries are right to a few units
  /// in the last place of a double. It adds up the first-order effects of errors of all diagonal
  /// entries, as if they never cancelled; on long chains it is thousands of times too large. Takes
  /// as long as Solve.
  double LargestNoise() const;

  /// The factor's columns of a supernode, over the rows of its front; the leading dimension is
  /// PaddedRows of the front's size. Above the diagonal nothing is defined.
  const double* panel(int s) const { return values_.data() + plan_.panel_start(s); }

  const SymbolicFactor& structure() const { return plan_.structure(); }

 private:
  template <typename Scalar>
  struct Workspace {
    std::vector<Scalar> front;    // the one being eliminated
    std::vector<Scalar> updates;  // stack of Schur complements that wait for their parents
  };

  template <typename Scalar>
  void MakeRoom(Workspace<Scalar>* work) const;
  template <typename Scalar>
  void Assemble(const SymmetricBlockMatrix<kDim, Scalar>& H, const Eigen::VectorXd& added, int s,
                std::vector<Scalar>* front);
  template <typename Scalar>
  void AddUpdates(int s, Workspace<Scalar>* work) const;
  template <typename Scalar>
  void StoreUpdate(int s, Workspace<Scalar>* work) const;
  void FindSmallestPivot();
  /// Row i of a supernode's front, as a row of the matrix in elimination order.
  std::size_t RowOfFront(int s, int i) const;
  void SolveLanes(double* x, int lanes) const;

  FrontPlan plan_{kDim};
  std::vector<double> values_;    // the factor
  std::vector<double> diagonal_;  // of the matrix, in elimination order
  double smallest_pivot_ = 0.0;
  Workspace<double> work_;
  std::vector<double> smallest_pivots_;     // of one front: a pivot below is rounding noise
  mutable std::vector<double> solve_work_;  // the right-hand sides of one front
};

extern template class SparseCholesky<2>;
extern template class SparseCholesky<3>;
extern template class SparseCholesky<4>;
extern template class SparseCholesky<6>;

}  // namespace loopgrid
