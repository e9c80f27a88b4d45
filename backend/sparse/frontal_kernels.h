#pragma once

#include <cstddef>

namespace loopgrid {

/// Dense kernels of the sparse Cholesky factorisation, for column-major matrices whose leading
/// dimension is a multiple of kRowAlignment: rows are computed in groups of that many, so the
/// padding rows below a matrix may be written. The results have the same bits on every x86-64
/// machine: AVX2 is used where the processor has it, in the same order of operations.
inline constexpr int kRowAlignment = 4;

/// The smallest leading dimension for this many rows.
constexpr int PaddedRows(int rows) {
  return (rows + kRowAlignment - 1) / kRowAlignment * kRowAlignment;
}

/// Entries of a dense front of this size with padded columns.
constexpr std::size_t PaddedArea(int rows, int cols) {
  return static_cast<std::size_t>(PaddedRows(rows)) * static_cast<std::size_t>(cols);
}

/// Element (p, j) of a factor is `data[p * row_stride + j * col_stride]`: a matrix or a transpose.
struct StridedMatrix {
  const double* data;
  int row_stride;
  int col_stride;
};

/// C += A * B, with C rows x cols, A rows x depth. `rows` is rounded up to a multiple of
/// kRowAlignment.
void MultiplyAdd(double* C, int ldc, const double* A, int lda, StridedMatrix B, int rows, int cols,
                 int depth);

/// C -= A * B, likewise.
void MultiplySubtract(double* C, int ldc, const double* A, int lda, StridedMatrix B, int rows,
                      int cols, int depth);

/// Eliminates the first `pivots` columns of the symmetric `size` x `size` matrix F whose lower
/// triangle is given: they become columns of its Cholesky factor, the rest becomes the Schur
/// complement. The strict upper triangle is scratch. False when a pivot is not above its entry in
/// `smallest_pivots`.
[[nodiscard]] bool EliminateColumns(double* F, int ld, int size, int pivots,
                                    const double* smallest_pivots);

/// The largest number of right-hand sides that are solved together (`lanes` below): as many as a
/// register holds. They lie side by side: x[lanes * i + k] is row i of the k-th.
inline constexpr int kMostLanes = 4;

/// With the first columns L = (L11; L21) of a factor, the rows x = (x1; x2) of right-hand sides
/// become (y; x2 - L21 y), where y = L11^-1 x1. `lanes` is 1 or kMostLanes.
void SolveForward(const double* L, int ld, int size, int pivots, double* x, int lanes);

/// The rows x = (y; z) become (L11^-T (y - L21^T z); z).
void SolveBackward(const double* L, int ld, int size, int pivots, double* x, int lanes);

/// One version of the functions above.
struct FrontalKernels {
  decltype(&MultiplyAdd) multiply_add;
  decltype(&MultiplySubtract) multiply_subtract;
  decltype(&EliminateColumns) eliminate_columns;
  decltype(&SolveForward) solve_forward;
  decltype(&SolveBackward) solve_backward;
};

/// The version for every processor, and the version for processors with AVX2, which is null if this
/// one has no AVX2. For tests: the functions above choose the fastest version that runs here.
const FrontalKernels& BaselineKernels();
const FrontalKernels* Avx2Kernels();

}  // namespace loopgrid
