#include "backend/sparse/sparse_cholesky.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "backend/sparse/frontal_kernels.h"
#include "backend/sparse/ordering.h"

namespace loopgrid {
namespace {

/// A pivot this small relative to its diagonal entry is rounding noise: the matrix is singular.
constexpr double kSmallestPivot = 1e-13;

/// When the factor has this many times the entries per block of the matrix that it had when the
/// order was found, a new order is worth its time.
constexpr double kWorthOrdering = 1.2;

/// Multiplications in the factorisation per column and end of an off-diagonal block from which on
/// the better order of nested dissection pays for its own time, within a few factorisations.
constexpr double kWorthDissecting = 1e4;

using ColumnMajor = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

std::size_t PaddedArea(int rows, int cols) {
  return static_cast<std::size_t>(PaddedRows(rows)) * static_cast<std::size_t>(cols);
}

/// Entries of the factor per block of the matrix.
double Fill(const SymbolicFactor& factor, int blocks) {
  return static_cast<double>(factor.entries) / std::max(1, blocks);
}

}  // namespace

template <int kDim>
void SparseCholesky<kDim>::Analyze(const Matrix& H) {
  if (!KeepOrder(H)) {
    structure_ = AnalyzeFactor(MinimumDegreeOrder(H.cols(), H.places()), H.places());
    const double ends = H.cols() + 2.0 * H.block_count();
    if (kDim * kDim * kDim * structure_.Operations() > kWorthDissecting * ends) {
      SymbolicFactor other = AnalyzeFactor(NestedDissectionOrder(H.cols(), H.places()), H.places());
      if (other.Operations() < structure_.Operations()) structure_ = std::move(other);
    }
    ordered_fill_ = Fill(structure_, H.block_count());
  }
  const int count = structure_.supernode_count();
  first_child_.assign(Index(count), -1);
  sibling_.assign(Index(count), -1);
  for (int s = 0; s < count; ++s) {
    const int parent = structure_.parent[Index(s)];
    if (parent == -1) continue;
    sibling_[Index(s)] = first_child_[Index(parent)];
    first_child_[Index(parent)] = s;
  }
  PlaceSources(H);
  PlaceMemory();
}

template <int kDim>
bool SparseCholesky<kDim>::KeepOrder(const Matrix& H) {
  std::vector<int> order = structure_.order;
  if (order.empty() || H.cols() < static_cast<int>(order.size())) return false;
  while (static_cast<int>(order.size()) < H.cols()) order.push_back(static_cast<int>(order.size()));
  SymbolicFactor kept = AnalyzeFactor(std::move(order), H.places());
  if (Fill(kept, H.block_count()) > kWorthOrdering * ordered_fill_) return false;
  structure_ = std::move(kept);
  return true;
}

template <int kDim>
void SparseCholesky<kDim>::PlaceSources(const Matrix& H) {
  const int count = structure_.supernode_count();
  std::vector<int> supernode_of(structure_.order.size());
  for (int s = 0; s < count; ++s) {
    for (int k = structure_.first_column[Index(s)]; k < structure_.first_column[Index(s) + 1];
         ++k) {
      supernode_of[Index(k)] = s;
    }
  }
  // Counting sort of the blocks by the supernode that eliminates their column.
  first_source_.assign(Index(count) + 1, 0);
  const auto supernode_at = [&](const BlockPlace& place) {
    return supernode_of[Index(
        std::min(structure_.position[Index(place.row)], structure_.position[Index(place.col)]))];
  };
  for (const BlockPlace& place : H.places()) ++first_source_[Index(supernode_at(place)) + 1];
  for (int s = 0; s < count; ++s) first_source_[Index(s) + 1] += first_source_[Index(s)];
  sources_.resize(H.places().size());
  std::vector<std::size_t> next(first_source_.begin(), first_source_.end() - 1);
  for (int block = 0; block < H.block_count(); ++block) {
    const BlockPlace& place = H.places()[Index(block)];
    const int a = structure_.position[Index(place.row)];
    const int b = structure_.position[Index(place.col)];
    const int s = supernode_at(place);
    sources_[next[Index(s)]++] = {block, structure_.PositionInFront(s, std::max(a, b)),
                                  std::min(a, b) - structure_.first_column[Index(s)], a < b};
  }
}

template <int kDim>
void SparseCholesky<kDim>::PlaceMemory() {
  const int count = structure_.supernode_count();
  panel_start_.assign(Index(count) + 1, 0);
  update_start_.assign(Index(count), 0);
  std::size_t stack_top = 0;
  std::size_t stack_size = 0;
  std::size_t front_size = 0;
  std::size_t largest = 0;
  for (int s = 0; s < count; ++s) {
    const int size = FrontSize(s);
    panel_start_[Index(s) + 1] =
        panel_start_[Index(s)] + PaddedArea(size, kDim * structure_.columns(s));
    front_size = std::max(front_size, PaddedArea(size, size));
    largest = std::max(largest, Index(size));
    for (int child = first_child_[Index(s)]; child != -1; child = sibling_[Index(child)]) {
      stack_top = update_start_[Index(child)];
    }
    const int below = kDim * structure_.row_count(s);
    update_start_[Index(s)] = stack_top;
    stack_top += PaddedArea(below, below);
    stack_size = std::max(stack_size, stack_top);
  }
  // Kernels read whole groups of rows, which may begin in mid-column: hence the extra rows. All of
  // it is written before it counts, so what a smaller matrix has left there may stay.
  values_.resize(panel_start_.back() + kRowAlignment);
  front_.resize(front_size + kRowAlignment);
  updates_.resize(stack_size);
  solve_work_.resize(kMostLanes * largest);
  smallest_pivots_.resize(Index(kDim) * structure_.order.size());
}

template <int kDim>
bool SparseCholesky<kDim>::Factorize(const Matrix& H, const Eigen::VectorXd& added) {
  assert(H.cols() == static_cast<int>(structure_.order.size()));
  assert(added.size() == 0 || added.size() == kDim * H.cols());
  for (int s = 0; s < structure_.supernode_count(); ++s) {
    const int size = FrontSize(s);
    const int ld = PaddedRows(size);
    const int pivots = kDim * structure_.columns(s);
    std::fill_n(front_.begin(), PaddedArea(size, size), 0.0);
    Assemble(H, added, s);
    AddUpdates(s);
    if (!EliminateColumns(front_.data(), ld, size, pivots,
                          &smallest_pivots_[Index(kDim * structure_.first_column[Index(s)])])) {
      return false;
    }
    std::copy_n(front_.begin(), PaddedArea(size, pivots),
                values_.begin() + static_cast<std::ptrdiff_t>(panel_start_[Index(s)]));
    const int below = size - pivots;
    double* const update = updates_.data() + update_start_[Index(s)];
    for (int j = 0; j < below; ++j) {
      std::copy_n(&front_[PaddedArea(size, pivots + j) + Index(pivots + j)], below - j,
                  update + PaddedArea(below, j) + j);
    }
  }
  return true;
}

template <int kDim>
void SparseCholesky<kDim>::Assemble(const Matrix& H, const Eigen::VectorXd& added, int s) {
  const int size = FrontSize(s);
  ColumnMajor front(front_.data(), size, size, Eigen::OuterStride<>(PaddedRows(size)));
  const int first = structure_.first_column[Index(s)];
  for (int k = 0; k < structure_.columns(s); ++k) {
    const int col = structure_.order[Index(first + k)];
    auto diagonal = front.template block<kDim, kDim>(kDim * k, kDim * k);
    diagonal = H.diagonal(col);
    if (added.size() > 0) diagonal.diagonal() += added.segment<kDim>(kDim * col);
    for (int i = 0; i < kDim; ++i) {
      smallest_pivots_[Index(kDim * (first + k) + i)] = kSmallestPivot * diagonal(i, i);
    }
  }
  for (std::size_t k = first_source_[Index(s)]; k < first_source_[Index(s) + 1]; ++k) {
    const Source& source = sources_[k];
    auto place = front.template block<kDim, kDim>(kDim * source.front_row, kDim * source.front_col);
    if (source.transposed) {
      place = H.off_diagonal(source.block).transpose();
    } else {
      place = H.off_diagonal(source.block);
    }
  }
}

template <int kDim>
void SparseCholesky<kDim>::AddUpdates(int s) {
  const int ld = PaddedRows(FrontSize(s));
  for (int child = first_child_[Index(s)]; child != -1; child = sibling_[Index(child)]) {
    const int count = structure_.row_count(child);
    const int* const target = &structure_.row_in_parent[structure_.first_row[Index(child)]];
    const int update_ld = PaddedRows(kDim * count);
    const double* update = updates_.data() + update_start_[Index(child)];
    for (int b = 0; b < count; ++b) {
      double* front = front_.data() + static_cast<std::ptrdiff_t>(kDim * target[b]) * ld;
      for (int j = 0; j < kDim; ++j, front += ld, update += update_ld) {
        // Above the diagonal of the diagonal block nothing is defined, nor needed.
        for (int i = j; i < kDim; ++i) front[kDim * target[b] + i] += update[kDim * b + i];
        for (int a = b + 1; a < count; ++a) {
          for (int i = 0; i < kDim; ++i) front[kDim * target[a] + i] += update[kDim * a + i];
        }
      }
    }
  }
}

template <int kDim>
void SparseCholesky<kDim>::SolveLanes(double* x, int lanes) const {
  const int block = lanes * kDim;  // numbers in one block row
  double* const work = solve_work_.data();
  const auto own = [&](int s) { return x + block * structure_.first_column[Index(s)]; };
  const auto rows = [&](int s) { return structure_.rows.data() + structure_.first_row[Index(s)]; };
  for (int s = 0; s < structure_.supernode_count(); ++s) {
    const int width = structure_.columns(s);
    double* const below = std::copy_n(own(s), block * width, work);
    std::fill_n(below, block * structure_.row_count(s), 0.0);
    SolveForward(panel(s), PaddedRows(FrontSize(s)), FrontSize(s), kDim * width, work, lanes);
    std::copy_n(work, block * width, own(s));
    for (int k = 0; k < structure_.row_count(s); ++k) {
      double* const row = x + block * rows(s)[k];
      for (int i = 0; i < block; ++i) row[i] += below[block * k + i];
    }
  }
  for (int s = structure_.supernode_count() - 1; s >= 0; --s) {
    const int width = structure_.columns(s);
    double* below = std::copy_n(own(s), block * width, work);
    for (int k = 0; k < structure_.row_count(s); ++k) {
      below = std::copy_n(x + block * rows(s)[k], block, below);
    }
    SolveBackward(panel(s), PaddedRows(FrontSize(s)), FrontSize(s), kDim * width, work, lanes);
    std::copy_n(work, block * width, own(s));
  }
}

template <int kDim>
Eigen::MatrixXd SparseCholesky<kDim>::Solve(const Eigen::Ref<const Eigen::MatrixXd>& rhs) const {
  assert(rhs.rows() == kDim * static_cast<Eigen::Index>(structure_.order.size()));
  const int lanes = rhs.cols() == 1 ? 1 : kMostLanes;
  Eigen::MatrixXd result(rhs.rows(), rhs.cols());
  Eigen::MatrixXd x(lanes, rhs.rows());  // in elimination order, right-hand sides side by side
  for (Eigen::Index first = 0; first < rhs.cols(); first += lanes) {
    const Eigen::Index count = std::min<Eigen::Index>(lanes, rhs.cols() - first);
    x.setZero();
    for (int i = 0; i < static_cast<int>(rhs.rows()); ++i) {
      const int from = kDim * structure_.order[Index(i / kDim)] + i % kDim;
      for (Eigen::Index k = 0; k < count; ++k) x(k, i) = rhs(from, first + k);
    }
    SolveLanes(x.data(), lanes);
    for (int i = 0; i < static_cast<int>(rhs.rows()); ++i) {
      const int to = kDim * structure_.order[Index(i / kDim)] + i % kDim;
      for (Eigen::Index k = 0; k < count; ++k) result(to, first + k) = x(k, i);
    }
  }
  return result;
}

template class SparseCholesky<2>;
template class SparseCholesky<3>;
template class SparseCholesky<4>;
template class SparseCholesky<6>;

}  // namespace loopgrid
