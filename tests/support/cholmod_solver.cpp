#include "tests/support/cholmod_solver.h"

#include <cholmod.h>

#include <cstddef>
#include <new>
#include <vector>

namespace loopgrid::test_support {
namespace {

/// A pivot this small relative to its diagonal entry is rounding noise: the matrix is singular.
constexpr double kSmallestPivot = 1e-14;

}  // namespace

template <int kDim>
class CholmodSolver<kDim>::Impl {
 public:
  Impl() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.supernodal = CHOLMOD_SIMPLICIAL;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_GIVEN;
    common_.postorder = 1;
    common_.final_ll = 1;
  }
  ~Impl() {
    FreeMatrices();
    cholmod_finish(&common_);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void Analyze(const SymmetricBlockMatrix<kDim>& H) {
    FreeMatrices();
    BuildPattern(H);
    const std::vector<int> order = OrderBlocks(H);
    std::vector<int> scalar_order(static_cast<std::size_t>(kDim) * order.size());
    for (std::size_t i = 0; i < scalar_order.size(); ++i) {
      scalar_order[i] = kDim * order[i / kDim] + static_cast<int>(i % kDim);
    }
    factor_ = Check(cholmod_analyze_p(matrix_, scalar_order.data(), nullptr, 0, &common_));
  }

  bool Factorize(const SymmetricBlockMatrix<kDim>& H) {
    FillValues(H);
    cholmod_factorize(matrix_, factor_, &common_);
    if (common_.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    return factor_->minor == factor_->n && PivotsAreSound();
  }

  Eigen::MatrixXd Solve(const Eigen::Ref<const Eigen::MatrixXd>& rhs) {
    Eigen::MatrixXd copy = rhs;
    cholmod_dense b{};
    b.nrow = static_cast<std::size_t>(copy.rows());
    b.ncol = static_cast<std::size_t>(copy.cols());
    b.d = b.nrow;
    b.nzmax = b.nrow * b.ncol;
    b.x = copy.data();
    b.xtype = CHOLMOD_REAL;
    b.dtype = CHOLMOD_DOUBLE;
    cholmod_dense* x = Check(cholmod_solve(CHOLMOD_A, factor_, &b, &common_));
    copy = Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(x->x), copy.rows(),
                                             copy.cols());
    cholmod_free_dense(&x, &common_);
    return copy;
  }

 private:
  template <typename T>
  static T* Check(T* object) {
    if (object == nullptr) throw std::bad_alloc();
    return object;
  }

  void FreeMatrices() {
    cholmod_free_factor(&factor_, &common_);
    cholmod_free_sparse(&matrix_, &common_);
  }

  // Builds the upper triangle by scalar columns, and the places where the columns of each block
  // begin.
  void BuildPattern(const SymmetricBlockMatrix<kDim>& H) {
    const int n = H.cols();
    std::vector<std::vector<int>> blocks_of_column(static_cast<std::size_t>(n));
    for (int k = 0; k < H.block_count(); ++k) {
      blocks_of_column[static_cast<std::size_t>(H.places()[static_cast<std::size_t>(k)].col)]
          .push_back(k);
    }
    const std::size_t scalars = static_cast<std::size_t>(kDim) * static_cast<std::size_t>(n);
    const std::size_t nonzeros = static_cast<std::size_t>(kDim * kDim * H.block_count()) +
                                 static_cast<std::size_t>(kDim + 1) * scalars / 2;
    matrix_ =
        Check(cholmod_allocate_sparse(scalars, scalars, nonzeros, 0, 1, 1, CHOLMOD_REAL, &common_));
    int* const starts = static_cast<int*>(matrix_->p);
    int* const rows = static_cast<int*>(matrix_->i);
    block_places_.assign(static_cast<std::size_t>(H.block_count()), {});
    int next = 0;
    for (int col = 0; col < n; ++col) {
      for (int c = 0; c < kDim; ++c) {
        starts[kDim * col + c] = next;
        for (int k : blocks_of_column[static_cast<std::size_t>(col)]) {
          block_places_[static_cast<std::size_t>(k)].start[c] = next;
          for (int r = 0; r < kDim; ++r)
            rows[next++] = kDim * H.places()[static_cast<std::size_t>(k)].row + r;
        }
        for (int r = 0; r <= c; ++r) rows[next++] = kDim * col + r;
      }
    }
    starts[kDim * n] = next;
  }

  // Approximate minimum degree on the graph of blocks: faster and no worse than on scalars.
  std::vector<int> OrderBlocks(const SymmetricBlockMatrix<kDim>& H) {
    const auto n = static_cast<std::size_t>(H.cols());
    cholmod_sparse* graph = Check(cholmod_allocate_sparse(
        n, n, static_cast<std::size_t>(H.block_count()), 0, 1, 1, CHOLMOD_PATTERN, &common_));
    int* const starts = static_cast<int*>(graph->p);
    int* const rows = static_cast<int*>(graph->i);
    std::fill(starts, starts + n + 1, 0);
    for (int k = 0; k < H.block_count(); ++k)
      ++starts[H.places()[static_cast<std::size_t>(k)].col + 1];
    for (std::size_t col = 0; col < n; ++col) starts[col + 1] += starts[col];
    std::vector<int> next(starts, starts + n);
    for (int k = 0; k < H.block_count(); ++k) {
      rows[next[static_cast<std::size_t>(H.places()[static_cast<std::size_t>(k)].col)]++] =
          H.places()[static_cast<std::size_t>(k)].row;
    }
    std::vector<int> order(n);
    const int done = cholmod_amd(graph, nullptr, 0, order.data(), &common_);
    cholmod_free_sparse(&graph, &common_);
    if (!done) throw std::bad_alloc();
    return order;
  }

  void FillValues(const SymmetricBlockMatrix<kDim>& H) {
    double* const values = static_cast<double*>(matrix_->x);
    for (int k = 0; k < H.block_count(); ++k) {
      const auto& block = H.off_diagonal(k);
      for (int c = 0; c < kDim; ++c) {
        Eigen::Map<Eigen::Matrix<double, kDim, 1>>(
            values + block_places_[static_cast<std::size_t>(k)].start[c]) = block.col(c);
      }
    }
    const int* const ends = static_cast<const int*>(matrix_->p) + 1;
    for (int col = 0; col < H.cols(); ++col) {
      const auto& block = H.diagonal(col);
      for (int c = 0; c < kDim; ++c) {
        double* const last = values + ends[kDim * col + c] - 1;
        for (int r = 0; r <= c; ++r) last[r - c] = block(r, c);
      }
    }
  }

  // Squares of the factor's diagonal are the pivots.
  bool PivotsAreSound() const {
    const int* const starts = static_cast<const int*>(factor_->p);
    const double* const values = static_cast<const double*>(factor_->x);
    const int* const order = static_cast<const int*>(factor_->Perm);
    const int* const ends = static_cast<const int*>(matrix_->p) + 1;
    const double* const matrix_values = static_cast<const double*>(matrix_->x);
    for (std::size_t j = 0; j < factor_->n; ++j) {
      const double pivot = values[starts[j]] * values[starts[j]];
      if (!(pivot > kSmallestPivot * matrix_values[ends[order[j]] - 1])) return false;
    }
    return true;
  }

  struct BlockPlace {
    int start[kDim];  // of each of the block's columns, in the values
  };

  cholmod_common common_;
  cholmod_sparse* matrix_ = nullptr;
  cholmod_factor* factor_ = nullptr;
  std::vector<BlockPlace> block_places_;
};

template <int kDim>
CholmodSolver<kDim>::CholmodSolver() : impl_(std::make_unique<Impl>()) {}
template <int kDim>
CholmodSolver<kDim>::~CholmodSolver() = default;
template <int kDim>
CholmodSolver<kDim>::CholmodSolver(CholmodSolver&&) noexcept = default;
template <int kDim>
CholmodSolver<kDim>& CholmodSolver<kDim>::operator=(CholmodSolver&&) noexcept = default;

template <int kDim>
void CholmodSolver<kDim>::Analyze(const SymmetricBlockMatrix<kDim>& H) {
  impl_->Analyze(H);
}

template <int kDim>
bool CholmodSolver<kDim>::Factorize(const SymmetricBlockMatrix<kDim>& H) {
  return impl_->Factorize(H);
}

template <int kDim>
Eigen::MatrixXd CholmodSolver<kDim>::Solve(const Eigen::Ref<const Eigen::MatrixXd>& rhs) const {
  return impl_->Solve(rhs);
}

template class CholmodSolver<2>;
template class CholmodSolver<3>;
template class CholmodSolver<6>;

}  // namespace loopgrid::test_support
