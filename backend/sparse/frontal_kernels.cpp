#include "backend/sparse/frontal_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace loopgrid {
namespace {

#if defined(__x86_64__) && defined(__GNUC__)
#define LOOPGRID_HAS_AVX2_VERSION 1
#define LOOPGRID_TARGET_AVX2 __attribute__((target("avx2")))
#endif
#define LOOPGRID_INLINE inline __attribute__((always_inline))

// What one register holds with SSE2 and with AVX2. Memory has them at any address.
using Vector2 = double __attribute__((vector_size(16)));
using Vector4 = double __attribute__((vector_size(32)));

template <typename Lane>
struct __attribute__((packed, may_alias)) AtAnyAddress {
  Lane value;
};

template <typename Lane>
LOOPGRID_INLINE void Load(const double* from, Lane* to) {
  *to = reinterpret_cast<const AtAnyAddress<Lane>*>(from)->value;
}

template <typename Lane>
LOOPGRID_INLINE void Store(const Lane& from, double* to) {
  reinterpret_cast<AtAnyAddress<Lane>*>(to)->value = from;
}

// C (+|-)= A * B for kVectors registers of rows and kCols columns, which are kept in registers.
template <typename Vector, int kVectors, int kCols, bool kAdd>
LOOPGRID_INLINE void Tile(double* C, std::ptrdiff_t ldc, const double* A, std::ptrdiff_t lda,
                          const StridedMatrix& B, int depth) {
  constexpr int kLanes = sizeof(Vector) / sizeof(double);
  const std::ptrdiff_t row_stride = B.row_stride;
  const std::ptrdiff_t col_stride = B.col_stride;
  const double* b = B.data;
  Vector sum[kCols][kVectors];
  for (int j = 0; j < kCols; ++j) {
    for (int v = 0; v < kVectors; ++v) Load(C + j * ldc + kLanes * v, &sum[j][v]);
  }
  for (int p = 0; p < depth; ++p, A += lda, b += row_stride) {
    for (int j = 0; j < kCols; ++j) {
      for (int v = 0; v < kVectors; ++v) {
        Vector product;
        Load(A + kLanes * v, &product);
        product *= b[j * col_stride];
        sum[j][v] = kAdd ? sum[j][v] + product : sum[j][v] - product;
      }
    }
  }
  for (int j = 0; j < kCols; ++j) {
    for (int v = 0; v < kVectors; ++v) Store(sum[j][v], C + j * ldc + kLanes * v);
  }
}

template <typename Vector, int kCols, bool kAdd>
LOOPGRID_INLINE void Strip(double* C, std::ptrdiff_t ldc, const double* A, std::ptrdiff_t lda,
                           const StridedMatrix& B, int rows, int depth) {
  constexpr int kLanes = sizeof(Vector) / sizeof(double);
  int i = 0;
  for (; i + 2 * kRowAlignment <= rows && kLanes == kRowAlignment; i += 2 * kRowAlignment) {
    Tile<Vector, 2, kCols, kAdd>(C + i, ldc, A + i, lda, B, depth);
  }
  for (; i < rows; i += kRowAlignment) {
    Tile<Vector, kRowAlignment / kLanes, kCols, kAdd>(C + i, ldc, A + i, lda, B, depth);
  }
}

template <typename Vector, bool kAdd>
LOOPGRID_INLINE void Product(double* C, std::ptrdiff_t ldc, const double* A, std::ptrdiff_t lda,
                             StridedMatrix B, int rows, int cols, int depth) {
  int j = 0;
  for (; j + 3 <= cols; j += 3) {
    Strip<Vector, 3, kAdd>(C + j * ldc, ldc, A, lda, B, rows, depth);
    B.data += 3 * static_cast<std::ptrdiff_t>(B.col_stride);
  }
  if (cols - j == 2) Strip<Vector, 2, kAdd>(C + j * ldc, ldc, A, lda, B, rows, depth);
  if (cols - j == 1) Strip<Vector, 1, kAdd>(C + j * ldc, ldc, A, lda, B, rows, depth);
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

template <typename Vector>
LOOPGRID_INLINE bool Eliminate(double* F, std::ptrdiff_t ld, int size, int pivots,
                               const double* smallest_pivots) {
  constexpr int kPanel = 3;
  for (int c = 0; c < size; c += kPanel) {
    const int width = std::min(kPanel, (c < pivots ? pivots : size) - c);
    // Rows start at a multiple of the alignment; what this writes above the diagonal is scratch.
    const int top = c / kRowAlignment * kRowAlignment;
    const int depth = std::min(c, pivots);
    const StridedMatrix left{F + c, static_cast<int>(ld), 1};
    Product<Vector, false>(F + c * ld + top, ld, F + top, ld, left, PaddedRows(size) - top, width,
                           depth);
    if (c < pivots && !FactorizePanel(F + c * ld + c, ld, size - c, width, smallest_pivots + c)) {
      return false;
    }
    if (c < pivots && width < kPanel) c -= kPanel - width;
  }
  return true;
}

// Lane is the type of a row of right-hand sides: double or Vector4.
template <typename Lane>
LOOPGRID_INLINE void Forward(const double* L, std::ptrdiff_t ld, int size, int pivots, double* x) {
  constexpr int kLanes = sizeof(Lane) / sizeof(double);
  for (int c = 0; c < pivots; ++c, L += ld) {
    Lane solved;
    Load(x + kLanes * c, &solved);
    solved *= 1.0 / L[c];
    Store(solved, x + kLanes * c);
    for (int i = c + 1; i < size; ++i) {
      Lane row;
      Load(x + kLanes * i, &row);
      row -= L[i] * solved;
      Store(row, x + kLanes * i);
    }
  }
}

template <typename Lane>
LOOPGRID_INLINE void Backward(const double* L, std::ptrdiff_t ld, int size, int pivots, double* x) {
  constexpr int kLanes = sizeof(Lane) / sizeof(double);
  // Several sums, since each addition waits for the one before; and the last row solved, which
  // everything waits for, comes last.
  constexpr int kSums = kLanes == 1 ? 4 : 2;
  L += (pivots - 1) * ld;
  for (int c = pivots - 1; c >= 0; --c, L -= ld) {
    Lane sums[kSums] = {};
    Lane row;
    int i = c + 2;
    for (; i + kSums <= size; i += kSums) {
      for (int k = 0; k < kSums; ++k) {
        Load(x + kLanes * (i + k), &row);
        sums[k] += L[i + k] * row;
      }
    }
    for (; i < size; ++i) {
      Load(x + kLanes * i, &row);
      sums[0] += L[i] * row;
    }
    Lane rest;
    Load(x + kLanes * c, &rest);
    for (int k = 0; k < kSums; ++k) rest -= sums[k];
    if (c + 1 < size) {
      Load(x + kLanes * (c + 1), &row);
      rest -= L[c + 1] * row;
    }
    rest *= 1.0 / L[c];
    Store(rest, x + kLanes * c);
  }
}

LOOPGRID_INLINE void ForwardLanes(const double* L, int ld, int size, int pivots, double* x,
                                  int lanes) {
  if (lanes == 1) return Forward<double>(L, ld, size, pivots, x);
  Forward<Vector4>(L, ld, size, pivots, x);
}

LOOPGRID_INLINE void BackwardLanes(const double* L, int ld, int size, int pivots, double* x,
                                   int lanes) {
  if (lanes == 1) return Backward<double>(L, ld, size, pivots, x);
  Backward<Vector4>(L, ld, size, pivots, x);
}

// One function of each kind for the instruction set that `target` enables, and a table of them.
#define LOOPGRID_KERNELS(Name, target, Vector)                                                     \
  target void MultiplyAdd##Name(double* C, int ldc, const double* A, int lda, StridedMatrix B,     \
                                int rows, int cols, int depth) {                                   \
    Product<Vector, true>(C, ldc, A, lda, B, rows, cols, depth);                                   \
  }                                                                                                \
  target void MultiplySubtract##Name(double* C, int ldc, const double* A, int lda,                 \
                                     StridedMatrix B, int rows, int cols, int depth) {             \
    Product<Vector, false>(C, ldc, A, lda, B, rows, cols, depth);                                  \
  }                                                                                                \
  target bool Eliminate##Name(double* F, int ld, int size, int pivots,                             \
                              const double* smallest_pivots) {                                     \
    return Eliminate<Vector>(F, ld, size, pivots, smallest_pivots);                                \
  }                                                                                                \
  target void Forward##Name(const double* L, int ld, int size, int pivots, double* x, int lanes) { \
    ForwardLanes(L, ld, size, pivots, x, lanes);                                                   \
  }                                                                                                \
  target void Backward##Name(const double* L, int ld, int size, int pivots, double* x,             \
                             int lanes) {                                                          \
    BackwardLanes(L, ld, size, pivots, x, lanes);                                                  \
  }                                                                                                \
  constexpr FrontalKernels k##Name{MultiplyAdd##Name, MultiplySubtract##Name, Eliminate##Name,     \
                                   Forward##Name, Backward##Name};

LOOPGRID_KERNELS(Baseline, , Vector2)
#ifdef LOOPGRID_HAS_AVX2_VERSION
LOOPGRID_KERNELS(Avx2, LOOPGRID_TARGET_AVX2, Vector4)
#endif
#undef LOOPGRID_KERNELS

const FrontalKernels& Fastest() {
  const FrontalKernels* const avx2 = Avx2Kernels();
  return avx2 != nullptr ? *avx2 : kBaseline;
}

const FrontalKernels& kKernels = Fastest();

}  // namespace

const FrontalKernels& BaselineKernels() { return kBaseline; }

const FrontalKernels* Avx2Kernels() {
#ifdef LOOPGRID_HAS_AVX2_VERSION
  if (__builtin_cpu_supports("avx2")) return &kAvx2;
#endif
  return nullptr;
}

void MultiplyAdd(double* C, int ldc, const double* A, int lda, StridedMatrix B, int rows, int cols,
                 int depth) {
  kKernels.multiply_add(C, ldc, A, lda, B, rows, cols, depth);
}

void MultiplySubtract(double* C, int ldc, const double* A, int lda, StridedMatrix B, int rows,
                      int cols, int depth) {
  kKernels.multiply_subtract(C, ldc, A, lda, B, rows, cols, depth);
}

bool EliminateColumns(double* F, int ld, int size, int pivots, const double* smallest_pivots) {
  return kKernels.eliminate_columns(F, ld, size, pivots, smallest_pivots);
}

void SolveForward(const double* L, int ld, int size, int pivots, double* x, int lanes) {
  kKernels.solve_forward(L, ld, size, pivots, x, lanes);
}

void SolveBackward(const double* L, int ld, int size, int pivots, double* x, int lanes) {
  kKernels.solve_backward(L, ld, size, pivots, x, lanes);
}

}  // namespace loopgrid
