#include "backend/sparse/selected_inverse.h"

#include <algorithm>
#include <cstddef>

#include "backend/base/index.h"
#include "backend/sparse/frontal_kernels.h"

namespace loopgrid {
namespace {

/// A column-major matrix whose columns begin at multiples of the kernels' row alignment.
class PaddedMatrix {
 public:
  void Resize(int rows, int cols) {
    ld_ = PaddedRows(rows);
    // Kernels read whole groups of rows, which may begin in mid-column: hence the extra rows.
    values_.assign(ToIndex(ld_) * ToIndex(cols) + kRowAlignment, 0.0);
  }

  int ld() const { return ld_; }
  double* data() { return values_.data(); }
  double& operator()(int row, int col) {
    return values_[ToIndex(row) + ToIndex(ld_) * ToIndex(col)];
  }

  /// This matrix as the right factor of a product.
  StridedMatrix AsFactor() const { return {values_.data(), 1, ld_}; }

 private:
  int ld_ = 0;
  std::vector<double> values_;
};

void Transpose(PaddedMatrix* from, int rows, int cols, double sign, PaddedMatrix* to) {
  to->Resize(cols, rows);
  for (int j = 0; j < cols; ++j) {
    for (int i = 0; i < rows; ++i) (*to)(j, i) = sign * (*from)(i, j);
  }
}

/// Computes the part of the inverse that a front spans, from its parent's. With the front's factor
/// (L11; L21) and Z22, the part over the rows below:
///     W = L21 L11^-1,  Z21 = -Z22 W,  Z11 = L11^-T L11^-1 - W^T Z21.
class FrontInverter {
 public:
  /// Z spans the front: its lower right part (Z22) is given, the rest is filled in if `fill`;
  /// the inverse over the front's own columns is left in own().
  void Invert(const double* panel, int size, int pivots, double* Z, int ldz, bool fill);

  PaddedMatrix& own() { return Z11_; }

 private:
  void InvertTriangle(const double* panel, int ld, int pivots);

  PaddedMatrix triangle_inverse_;  // M = L11^-1
  PaddedMatrix transposed_;
  PaddedMatrix W_;
  PaddedMatrix Z21_;
  PaddedMatrix Z11_;
};

void FrontInverter::InvertTriangle(const double* panel, int ld, int pivots) {
  PaddedMatrix& M = triangle_inverse_;
  M.Resize(pivots, pivots);
  for (int j = 0; j < pivots; ++j) {
    M(j, j) = 1.0;
    for (int p = j; p < pivots; ++p) {
      const double* const L = panel + static_cast<std::ptrdiff_t>(p) * ld;
      const double value = M(p, j) / L[p];
      M(p, j) = value;
      for (int i = p + 1; i < pivots; ++i) M(i, j) -= L[i] * value;
    }
  }
}

void FrontInverter::Invert(const double* panel, int size, int pivots, double* Z, int ldz,
                           bool fill) {
  const int ld = PaddedRows(size);
  const int below = size - pivots;
  InvertTriangle(panel, ld, pivots);
  Transpose(&triangle_inverse_, pivots, pivots, 1.0, &transposed_);
  Z11_.Resize(pivots, pivots);
  MultiplyAdd(Z11_.data(), Z11_.ld(), transposed_.data(), transposed_.ld(),
              triangle_inverse_.AsFactor(), pivots, pivots, pivots);
  if (below > 0) {
    W_.Resize(below, pivots);
    MultiplyAdd(W_.data(), W_.ld(), panel + pivots, ld, triangle_inverse_.AsFactor(), below, pivots,
                pivots);
    Z21_.Resize(below, pivots);
    MultiplySubtract(Z21_.data(), Z21_.ld(), Z + pivots + static_cast<std::ptrdiff_t>(pivots) * ldz,
                     ldz, W_.AsFactor(), below, pivots, below);
    Transpose(&W_, below, pivots, 1.0, &transposed_);
    MultiplySubtract(Z11_.data(), Z11_.ld(), transposed_.data(), transposed_.ld(), Z21_.AsFactor(),
                     pivots, pivots, below);
  }
  if (!fill) return;
  for (int j = 0; j < pivots; ++j) {
    double* const column = Z + static_cast<std::ptrdiff_t>(j) * ldz;
    for (int i = 0; i < pivots; ++i) column[i] = Z11_(i, j);
    for (int i = 0; i < below; ++i) {
      column[pivots + i] = Z21_(i, j);
      Z[j + static_cast<std::ptrdiff_t>(pivots + i) * ldz] = Z21_(i, j);
    }
  }
}

/// Inverts front after front from the last to the first: depth first from the roots, so that the
/// part of the inverse over each front can lie on a stack, right behind its parent's.
template <int kDim>
class SelectedInversion {
 public:
  using Blocks = std::vector<Eigen::Matrix<double, kDim, kDim>>;

  explicit SelectedInversion(const SparseCholesky<kDim>& factor)
      : factor_(factor), structure_(factor.structure()) {
    PlaceFronts();
  }

  Blocks Run() {
    Blocks blocks(structure_.order.size());
    for (int s = structure_.supernode_count() - 1; s >= 0; --s) InvertFront(s, &blocks);
    return blocks;
  }

 private:
  int Size(int s) const { return kDim * (structure_.columns(s) + structure_.row_count(s)); }
  double* Front(int s) { return stack_.data() + start_[ToIndex(s)]; }

  void PlaceFronts() {
    const int count = structure_.supernode_count();
    start_.assign(ToIndex(count), 0);
    has_child_.assign(ToIndex(count), false);
    std::size_t stack_size = 0;
    const auto end_of = [this](int s) {
      return start_[ToIndex(s)] + ToIndex(PaddedRows(Size(s))) * ToIndex(Size(s));
    };
    for (int s = count - 1; s >= 0; --s) {
      const int parent = structure_.parent[ToIndex(s)];
      if (parent != -1) {
        has_child_[ToIndex(parent)] = true;
        start_[ToIndex(s)] = end_of(parent);
      }
      stack_size = std::max(stack_size, end_of(s));
    }
    stack_.assign(stack_size + kRowAlignment, 0.0);  // extra rows as in PaddedMatrix
  }

  void InvertFront(int s, Blocks* blocks) {
    const int size = Size(s);
    const int ld = PaddedRows(size);
    const int pivots = kDim * structure_.columns(s);
    if (structure_.parent[ToIndex(s)] != -1) {
      GatherFromParent(s, Front(s) + pivots + static_cast<std::ptrdiff_t>(pivots) * ld, ld);
    }
    inverter_.Invert(factor_.panel(s), size, pivots, Front(s), ld, has_child_[ToIndex(s)]);
    for (int k = 0; k < structure_.columns(s); ++k) {
      auto& block =
          (*blocks)[ToIndex(structure_.order[ToIndex(structure_.first_column[ToIndex(s)] + k)])];
      for (int j = 0; j < kDim; ++j) {
        for (int i = 0; i < kDim; ++i) block(i, j) = inverter_.own()(kDim * k + i, kDim * k + j);
      }
    }
  }

  /// Copies what the parent has over the rows of s.
  void GatherFromParent(int s, double* Z22, int ld) {
    const int parent = structure_.parent[ToIndex(s)];
    const std::ptrdiff_t parent_ld = PaddedRows(Size(parent));
    const int* const positions = structure_.row_in_parent.data() + structure_.first_row[ToIndex(s)];
    const int count = structure_.row_count(s);
    for (int b = 0; b < count; ++b) {
      for (int j = 0; j < kDim; ++j, Z22 += ld) {
        const double* const from = Front(parent) + (kDim * positions[b] + j) * parent_ld;
        for (int a = 0; a < count; ++a) {
          for (int i = 0; i < kDim; ++i) Z22[kDim * a + i] = from[kDim * positions[a] + i];
        }
      }
    }
  }

  const SparseCholesky<kDim>& factor_;
  const SymbolicFactor& structure_;
  FrontInverter inverter_;
  std::vector<bool> has_child_;
  std::vector<std::size_t> start_;  // of each front on the stack
  std::vector<double> stack_;
};

}  // namespace

template <int kDim>
std::vector<Eigen::Matrix<double, kDim, kDim>> InverseDiagonal(const SparseCholesky<kDim>& factor) {
  return SelectedInversion<kDim>(factor).Run();
}

template std::vector<Eigen::Matrix3d> InverseDiagonal(const SparseCholesky<3>& factor);
template std::vector<Eigen::Matrix<double, 6, 6>> InverseDiagonal(const SparseCholesky<6>& factor);

}  // namespace loopgrid
