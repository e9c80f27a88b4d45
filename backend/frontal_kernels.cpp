#include "backend/frontal_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace loopgrid {
namespace {

#if defined(__x86_64__) && defined(__GNUC__)
#define LOOPGRID_HAS_AVX2_VERSION 1
#define LOOPGRID_TARGET_AVX2 __attribute__((target("avx2")))
#endif
#define LOOPGRID_INLINE inline __attribute__((always_inline))

// Four doubles: one register with AVX2, two with SSE2. May be at any address.
using Vector4 = double __attribute__((vector_size(32), aligned(8), may_alias));

// C(0:4 kGroups, 0:kCols) (+|-)= A * B, accumulated in registers.
template <int kGroups, int kCols, bool kAdd>
LOOPGRID_INLINE void Tile(double* C, std::ptrdiff_t ldc, const double* A, std::ptrdiff_t lda,
                          const double* B, std::ptrdiff_t row_stride, std::ptrdiff_t col_stride,
                          int depth) {
  Vector4 sum[kCols][kGroups];
  for (int j = 0; j < kCols; ++j) {
    for (int g = 0; g < kGroups; ++g) {
      sum[j][g] = *reinterpret_cast<const Vector4*>(C + j * ldc + 4 * g);
    }
  }
  for (int p = 0; p < depth; ++p, A += lda, B += row_stride) {
    for (int j = 0; j < kCols; ++j) {
      for (int g = 0; g < kGroups; ++g) {
        const Vector4 product = *reinterpret_cast<const Vector4*>(A + 4 * g) * B[j * col_stride];
        sum[j][g] = kAdd ? sum[j][g] + product : sum[j][g] - product;
      }
    }
  }
  for (int j = 0; j < kCols; ++j) {
    for (int g = 0; g < kGroups; ++g) {
      *reinterpret_cast<Vector4*>(C + j * ldc + 4 * g) = sum[j][g];
    }
  }
}

template <int kCols, bool kAdd>
LOOPGRID_INLINE void Strip(double* C, std::ptrdiff_t ldc, const double* A, std::ptrdiff_t lda,
                           const StridedMatrix& B, int rows, int depth) {
  int i = 0;
  for (; i + 8 <= rows; i += 8) {
    Tile<2, kCols, kAdd>(C + i, ldc, A + i, lda, B.data, B.row_stride, B.col_stride, depth);
  }
  for (; i < rows; i += 4) {
    Tile<1, kCols, kAdd>(C + i, ldc, A + i, lda, B.data, B.row_stride, B.col_stride, depth);
  }
}

template <bool kAdd>
LOOPGRID_INLINE void Product(double* C, std::ptrdiff_t ldc, const double* A, std::ptrdiff_t lda,
                             StridedMatrix B, int rows, int cols, int depth) {
  int j = 0;
  for (; j + 3 <= cols; j += 3) {
    Strip<3, kAdd>(C + j * ldc, ldc, A, lda, B, rows, depth);
    B.data += 3 * static_cast<std::ptrdiff_t>(B.col_stride);
  }
  if (cols - j == 2) Strip<2, kAdd>(C + j * ldc, ldc, A, lda, B, rows, depth);
  if (cols - j == 1) Strip<1, kAdd>(C + j * ldc, ldc, A, lda, B, rows, depth);
}

// Cholesky of the `width` columns that begin at `diagonal`, over `rows` rows, without updates
// from the left.
LOOPGRID_INLINE bool FactorizePanel(double* diagonal, std::ptrdiff_t ld, int rows, int width,
                                    const double* smallest_pivots) {
  for (int c = 0; c < width; ++c) {
    double* const column = diagonal + c * ld;
    for (int b = 0; b < c; ++b) {
      const double* const left = diagonal + b * ld;
      const double factor = left[c];
      for (int i = c; i < rows; ++i) column[i] -= factor * left[i];
    }
    const double pivot = column[c];
    if (!(pivot > smallest_pivots[c])) return false;
    const double root = std::sqrt(pivot);
    const double scale = 1.0 / root;
    column[c] = root;
    for (int i = c + 1; i < rows; ++i) column[i] *= scale;
  }
  return true;
}

LOOPGRID_INLINE bool Eliminate(double* F, std::ptrdiff_t ld, int size, int pivots,
                               const double* smallest_pivots) {
  constexpr int kPanel = 3;
  for (int c = 0; c < size; c += kPanel) {
    const int width = std::min(kPanel, (c < pivots ? pivots : size) - c);
    // Rows start at a multiple of the alignment; what this writes above the diagonal is scratch.
    const int top = c / kRowAlignment * kRowAlignment;
    const int depth = std::min(c, pivots);
    const StridedMatrix left{F + c, static_cast<int>(ld), 1};
    Product<false>(F + c * ld + top, ld, F + top, ld, left, PaddedRows(size) - top, width, depth);
    if (c < pivots && !FactorizePanel(F + c * ld + c, ld, size - c, width, smallest_pivots + c)) {
      return false;
    }
    if (c < pivots && width < kPanel) c -= kPanel - width;
  }
  return true;
}

// Lane is the type of a row of right-hand sides: double or Vector4.
template <typename Lane>
LOOPGRID_INLINE void Forward(const double* L, std::ptrdiff_t ld, int size, int pivots, Lane* x) {
  for (int c = 0; c < pivots; ++c, L += ld) {
    const Lane solved = x[c] * (1.0 / L[c]);
    x[c] = solved;
    for (int i = c + 1; i < size; ++i) x[i] -= L[i] * solved;
  }
}

template <typename Lane>
LOOPGRID_INLINE void Backward(const double* L, std::ptrdiff_t ld, int size, int pivots, Lane* x) {
  // Several sums, since each addition waits for the one before; and the last row solved, which
  // everything waits for, comes last.
  constexpr int kSums = sizeof(Lane) == sizeof(double) ? 4 : 2;
  L += (pivots - 1) * ld;
  for (int c = pivots - 1; c >= 0; --c, L -= ld) {
    Lane sums[kSums] = {};
    int i = c + 2;
    for (; i + kSums <= size; i += kSums) {
      for (int k = 0; k < kSums; ++k) sums[k] += L[i + k] * x[i + k];
    }
    for (; i < size; ++i) sums[i % kSums] += L[i] * x[i];
    Lane rest = x[c];
    for (int k = 0; k < kSums; ++k) rest -= sums[k];
    const double scale = 1.0 / L[c];
    x[c] = c + 1 < size ? (rest - L[c + 1] * x[c + 1]) * scale : rest * scale;
  }
}

LOOPGRID_INLINE void ForwardLanes(const double* L, int ld, int size, int pivots, double* x,
                                  int lanes) {
  if (lanes == 1) return Forward(L, ld, size, pivots, x);
  Forward(L, ld, size, pivots, reinterpret_cast<Vector4*>(x));
}

LOOPGRID_INLINE void BackwardLanes(const double* L, int ld, int size, int pivots, double* x,
                                   int lanes) {
  if (lanes == 1) return Backward(L, ld, size, pivots, x);
  Backward(L, ld, size, pivots, reinterpret_cast<Vector4*>(x));
}

#ifdef LOOPGRID_HAS_AVX2_VERSION
LOOPGRID_TARGET_AVX2 void AddAvx2(double* C, int ldc, const double* A, int lda, StridedMatrix B,
                                  int rows, int cols, int depth) {
  Product<true>(C, ldc, A, lda, B, rows, cols, depth);
}
LOOPGRID_TARGET_AVX2 void SubtractAvx2(double* C, int ldc, const double* A, int lda,
                                       StridedMatrix B, int rows, int cols, int depth) {
  Product<false>(C, ldc, A, lda, B, rows, cols, depth);
}
LOOPGRID_TARGET_AVX2 bool EliminateAvx2(double* F, int ld, int size, int pivots,
                                        const double* smallest_pivots) {
  return Eliminate(F, ld, size, pivots, smallest_pivots);
}
LOOPGRID_TARGET_AVX2 void ForwardAvx2(const double* L, int ld, int size, int pivots, double* x,
                                      int lanes) {
  ForwardLanes(L, ld, size, pivots, x, lanes);
}
LOOPGRID_TARGET_AVX2 void BackwardAvx2(const double* L, int ld, int size, int pivots, double* x,
                                       int lanes) {
  BackwardLanes(L, ld, size, pivots, x, lanes);
}
const bool kHasAvx2 = __builtin_cpu_supports("avx2");
#endif

}  // namespace

void MultiplyAdd(double* C, int ldc, const double* A, int lda, StridedMatrix B, int rows, int cols,
                 int depth) {
#ifdef LOOPGRID_HAS_AVX2_VERSION
  if (kHasAvx2) return AddAvx2(C, ldc, A, lda, B, rows, cols, depth);
#endif
  Product<true>(C, ldc, A, lda, B, rows, cols, depth);
}

void MultiplySubtract(double* C, int ldc, const double* A, int lda, StridedMatrix B, int rows,
                      int cols, int depth) {
#ifdef LOOPGRID_HAS_AVX2_VERSION
  if (kHasAvx2) return SubtractAvx2(C, ldc, A, lda, B, rows, cols, depth);
#endif
  Product<false>(C, ldc, A, lda, B, rows, cols, depth);
}

bool EliminateColumns(double* F, int ld, int size, int pivots, const double* smallest_pivots) {
#ifdef LOOPGRID_HAS_AVX2_VERSION
  if (kHasAvx2) return EliminateAvx2(F, ld, size, pivots, smallest_pivots);
#endif
  return Eliminate(F, ld, size, pivots, smallest_pivots);
}

void SolveForward(const double* L, int ld, int size, int pivots, double* x, int lanes) {
#ifdef LOOPGRID_HAS_AVX2_VERSION
  if (kHasAvx2) return ForwardAvx2(L, ld, size, pivots, x, lanes);
#endif
  ForwardLanes(L, ld, size, pivots, x, lanes);
}

void SolveBackward(const double* L, int ld, int size, int pivots, double* x, int lanes) {
#ifdef LOOPGRID_HAS_AVX2_VERSION
  if (kHasAvx2) return BackwardAvx2(L, ld, size, pivots, x, lanes);
#endif
  BackwardLanes(L, ld, size, pivots, x, lanes);
}

}  // namespace loopgrid
