#include "backend/sparse/sparse_cholesky.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "backend/base/index.h"
#include "backend/sparse/frontal_kernels.h"

namespace loopgrid {
namespace {

/// A pivot of less than this share of its diagonal entry has hardly a digit that is no rounding
/// error (2e-16 for each of the terms that were subtracted).
constexpr double kSmallestPivot = 1e-13;

/// How wrong a diagonal entry may be with twice the digits, as a share of it. The arithmetic is
/// good to 1e-32, but matrices J^T Omega J are made of Jacobians that are rounded to double: where
/// J v should be zero, it is 1e-16 times the terms that cancel, or more where these come from poses
/// far from the origin. This is the square of 1e-14.
constexpr double kExactNoise = 1e-28;

/// The same in double precision: a few units in the last place.
constexpr double kNoise = 1e-15;

}  // namespace

template <int kDim>
void SparseCholesky<kDim>::Analyze(const Matrix& H) {
  plan_.Analyze(H.cols(), H.places());
  // Kernels read whole groups of rows, which may begin in mid-column: hence the extra rows. All of
  // it is written before it counts, so what a smaller matrix has left there may stay.
  values_.resize(plan_.panels_size() + kRowAlignment);
  diagonal_.resize(ToIndex(kDim * H.cols()));
  solve_work_.resize(kMostLanes * ToIndex(plan_.largest_front()));
  MakeRoom(&work_);
}

template <int kDim>
template <typename Scalar>
void SparseCholesky<kDim>::MakeRoom(Workspace<Scalar>* work) const {
  work->front.resize(PaddedArea(plan_.largest_front(), plan_.largest_front()) + kRowAlignment);
  work->updates.resize(plan_.updates_size());
}

template <int kDim>
bool SparseCholesky<kDim>::Factorize(const Matrix& H, const Eigen::VectorXd& added) {
  const SymbolicFactor& structure = plan_.structure();
  assert(H.cols() == static_cast<int>(structure.order.size()));
  assert(added.size() == 0 || added.size() == kDim * H.cols());
  for (int s = 0; s < structure.supernode_count(); ++s) {
    const int size = plan_.front_size(s);
    const int pivots = plan_.pivots(s);
    Assemble(H, added, s, &work_.front);
    AddUpdates(s, &work_);
    const double* const diagonal = &diagonal_[ToIndex(kDim * structure.first_column[ToIndex(s)])];
    smallest_pivots_.resize(ToIndex(pivots));
    for (int i = 0; i < pivots; ++i) smallest_pivots_[ToIndex(i)] = kSmallestPivot * diagonal[i];
    if (!EliminateColumns(work_.front.data(), PaddedRows(size), size, pivots,
                          smallest_pivots_.data())) {
      return false;
    }
    std::copy_n(work_.front.begin(), PaddedArea(size, pivots),
                values_.begin() + static_cast<std::ptrdiff_t>(plan_.panel_start(s)));
    StoreUpdate(s, &work_);
  }
  FindSmallestPivot();
  return true;
}

template <int kDim>
Definiteness SparseCholesky<kDim>::FactorizeExactly(const ExactMatrix& H,
                                                    const Eigen::VectorXd& added) {
  const SymbolicFactor& structure = plan_.structure();
  assert(H.cols() == static_cast<int>(structure.order.size()));
  assert(added.size() == 0 || added.size() == kDim * H.cols());
  Workspace<DoubleDouble> work;
  MakeRoom(&work);
  std::vector<double> noise(diagonal_.size(), 0.0);  // that elimination has added, by row
  std::vector<double> front_noise;
  Definiteness result = Definiteness::kDefinite;
  for (int s = 0; s < structure.supernode_count(); ++s) {
    const int size = plan_.front_size(s);
    const int pivots = plan_.pivots(s);
    Assemble(H, added, s, &work.front);
    AddUpdates(s, &work);
    front_noise.resize(ToIndex(size));
    for (int i = 0; i < size; ++i) {
      const std::size_t row = RowOfFront(s, i);
      front_noise[ToIndex(i)] = noise[row] + (i < pivots ? kExactNoise * diagonal_[row] : 0.0);
    }
    result = std::max(result,
                      EliminateExactly(work.front.data(), PaddedRows(size), size, pivots,
                                       front_noise.data(), values_.data() + plan_.panel_start(s)));
    if (result == Definiteness::kIndefinite) return result;
    for (int i = pivots; i < size; ++i) noise[RowOfFront(s, i)] = front_noise[ToIndex(i)];
    StoreUpdate(s, &work);
  }
  FindSmallestPivot();
  return result;
}

template <int kDim>
Eigen::MatrixXd SparseCholesky<kDim>::FreeDirections(int most) {
  const SymbolicFactor& structure = plan_.structure();
  std::vector<double*> pivots;  // infinite ones, with zeros below them
  std::vector<int> variables;
  for (int s = 0; s < structure.supernode_count(); ++s) {
    const std::ptrdiff_t step = PaddedRows(plan_.front_size(s)) + 1;
    double* const first = values_.data() + plan_.panel_start(s);
    for (int i = 0; i < plan_.pivots(s); ++i) {
      if (!std::isinf(first[i * step])) continue;
      pivots.push_back(first + i * step);
      const std::size_t row = RowOfFront(s, i);
      variables.push_back(kDim * structure.order[row / kDim] + static_cast<int>(row % kDim));
    }
  }
  const Eigen::Index rows = kDim * static_cast<Eigen::Index>(structure.order.size());
  if (static_cast<int>(pivots.size()) > most) return Eigen::MatrixXd(rows, 0);
  // With a pivot of 1 in its place, L^T v = e has the solution that is 1 there.
  Eigen::MatrixXd units = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(pivots.size()));
  for (std::size_t k = 0; k < pivots.size(); ++k) {
    *pivots[k] = 1.0;
    units(variables[k], static_cast<Eigen::Index>(k)) = 1.0;
  }
  Eigen::MatrixXd directions = Solve(units);  // L e = e: nothing is below the pivots
  for (double* pivot : pivots) *pivot = std::numeric_limits<double>::infinity();
  return directions;
}

template <int kDim>
std::size_t SparseCholesky<kDim>::RowOfFront(int s, int i) const {
  const SymbolicFactor& structure = plan_.structure();
  const int block = i / kDim;
  const int own = structure.columns(s);
  const int row = block < own
                      ? structure.first_column[ToIndex(s)] + block
                      : structure.rows[structure.first_row[ToIndex(s)] + ToIndex(block - own)];
  return ToIndex(kDim * row + i % kDim);
}

template <int kDim>
double SparseCholesky<kDim>::LargestNoise() const {
  const SymbolicFactor& structure = plan_.structure();
  std::vector<double> noise(diagonal_.size());
  for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = kNoise * diagonal_[i];
  double largest = 0.0;
  for (int s = 0; s < structure.supernode_count(); ++s) {
    const int size = plan_.front_size(s);
    const double* column = panel(s);
    for (int c = 0; c < plan_.pivots(s); ++c, column += PaddedRows(size)) {
      const double share = noise[RowOfFront(s, c)] / (column[c] * column[c]);
      largest = std::max(largest, share);
      for (int i = c + 1; i < size; ++i) noise[RowOfFront(s, i)] += column[i] * column[i] * share;
    }
  }
  return largest;
}

template <int kDim>
template <typename Scalar>
void SparseCholesky<kDim>::Assemble(const SymmetricBlockMatrix<kDim, Scalar>& H,
                                    const Eigen::VectorXd& added, int s,
                                    std::vector<Scalar>* front_values) {
  using Front = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  const SymbolicFactor& structure = plan_.structure();
  const int size = plan_.front_size(s);
  std::fill_n(front_values->begin(), PaddedArea(size, size), Scalar(0.0));
  Eigen::Map<Front, 0, Eigen::OuterStride<>> front(front_values->data(), size, size,
                                                   Eigen::OuterStride<>(PaddedRows(size)));
  const int first = structure.first_column[ToIndex(s)];
  for (int k = 0; k < structure.columns(s); ++k) {
    const int col = structure.order[ToIndex(first + k)];
    auto diagonal = front.template block<kDim, kDim>(kDim * k, kDim * k);
    diagonal = H.diagonal(col);
    for (int i = 0; i < kDim; ++i) {
      if (added.size() > 0) diagonal(i, i) += Scalar(added[kDim * col + i]);
      diagonal_[ToIndex(kDim * (first + k) + i)] = static_cast<double>(diagonal(i, i));
    }
  }
  for (const FrontPlan::Source& source : plan_.sources(s)) {
    auto place = front.template block<kDim, kDim>(kDim * source.front_row, kDim * source.front_col);
    if (source.transposed) {
      place = H.off_diagonal(source.block).transpose();
    } else {
      place = H.off_diagonal(source.block);
    }
  }
}

template <int kDim>
template <typename Scalar>
void SparseCholesky<kDim>::AddUpdates(int s, Workspace<Scalar>* work) const {
  const SymbolicFactor& structure = plan_.structure();
  const int ld = PaddedRows(plan_.front_size(s));
  for (int child = plan_.last_child(s); child != -1; child = plan_.sibling(child)) {
    const int count = structure.row_count(child);
    const int* const target = &structure.row_in_parent[structure.first_row[ToIndex(child)]];
    const int update_ld = PaddedRows(kDim * count);
    const Scalar* update = work->updates.data() + plan_.update_start(child);
    for (int b = 0; b < count; ++b) {
      Scalar* front = work->front.data() + static_cast<std::ptrdiff_t>(kDim * target[b]) * ld;
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

/// Keeps what elimination has left of the front for its parent.
template <int kDim>
template <typename Scalar>
void SparseCholesky<kDim>::StoreUpdate(int s, Workspace<Scalar>* work) const {
  const int size = plan_.front_size(s);
  const int pivots = plan_.pivots(s);
  const int below = size - pivots;
  Scalar* const update = work->updates.data() + plan_.update_start(s);
  for (int j = 0; j < below; ++j) {
    std::copy_n(&work->front[PaddedArea(size, pivots + j) + ToIndex(pivots + j)], below - j,
                update + PaddedArea(below, j) + j);
  }
}

template <int kDim>
void SparseCholesky<kDim>::FindSmallestPivot() {
  const SymbolicFactor& structure = plan_.structure();
  smallest_pivot_ = std::numeric_limits<double>::infinity();
  for (int s = 0; s < structure.supernode_count(); ++s) {
    const std::ptrdiff_t step = PaddedRows(plan_.front_size(s)) + 1;
    const double* const diagonal = &diagonal_[ToIndex(kDim * structure.first_column[ToIndex(s)])];
    for (int i = 0; i < plan_.pivots(s); ++i) {
      const double root = panel(s)[i * step];
      smallest_pivot_ = std::min(smallest_pivot_, root * root / diagonal[i]);
    }
  }
}

template <int kDim>
void SparseCholesky<kDim>::SolveLanes(double* x, int lanes) const {
  const SymbolicFactor& structure = plan_.structure();
  const int block = lanes * kDim;  // numbers in one block row
  double* const work = solve_work_.data();
  const auto own = [&](int s) { return x + block * structure.first_column[ToIndex(s)]; };
  const auto rows = [&](int s) { return structure.rows.data() + structure.first_row[ToIndex(s)]; };
  for (int s = 0; s < structure.supernode_count(); ++s) {
    const int width = structure.columns(s);
    double* const below = std::copy_n(own(s), block * width, work);
    std::fill_n(below, block * structure.row_count(s), 0.0);
    SolveForward(panel(s), PaddedRows(plan_.front_size(s)), plan_.front_size(s), kDim * width, work,
                 lanes);
    std::copy_n(work, block * width, own(s));
    for (int k = 0; k < structure.row_count(s); ++k) {
      double* const row = x + block * rows(s)[k];
      for (int i = 0; i < block; ++i) row[i] += below[block * k + i];
    }
  }
  for (int s = structure.supernode_count() - 1; s >= 0; --s) {
    const int width = structure.columns(s);
    double* below = std::copy_n(own(s), block * width, work);
    for (int k = 0; k < structure.row_count(s); ++k) {
      below = std::copy_n(x + block * rows(s)[k], block, below);
    }
    SolveBackward(panel(s), PaddedRows(plan_.front_size(s)), plan_.front_size(s), kDim * width,
                  work, lanes);
    std::copy_n(work, block * width, own(s));
  }
}

template <int kDim>
Eigen::MatrixXd SparseCholesky<kDim>::Solve(const Eigen::Ref<const Eigen::MatrixXd>& rhs) const {
  const SymbolicFactor& structure = plan_.structure();
  assert(rhs.rows() == kDim * static_cast<Eigen::Index>(structure.order.size()));
  const int lanes = rhs.cols() == 1 ? 1 : kMostLanes;
  Eigen::MatrixXd result(rhs.rows(), rhs.cols());
  Eigen::MatrixXd x(lanes, rhs.rows());  // in elimination order, right-hand sides side by side
  for (Eigen::Index first = 0; first < rhs.cols(); first += lanes) {
    const Eigen::Index count = std::min<Eigen::Index>(lanes, rhs.cols() - first);
    x.setZero();
    for (int i = 0; i < static_cast<int>(rhs.rows()); ++i) {
      const int from = kDim * structure.order[ToIndex(i / kDim)] + i % kDim;
      for (Eigen::Index k = 0; k < count; ++k) x(k, i) = rhs(from, first + k);
    }
    SolveLanes(x.data(), lanes);
    for (int i = 0; i < static_cast<int>(rhs.rows()); ++i) {
      const int to = kDim * structure.order[ToIndex(i / kDim)] + i % kDim;
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
