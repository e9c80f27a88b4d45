#include "backend/sparse/exact_elimination.h"

#include <cmath>
#include <cstddef>
#include <limits>

namespace loopgrid {
namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();

/// Subtracts column * column^T / pivot from what is right of the column. If the pivot is wrong by
/// noise[0], what is left at row j is wrong by (column[j] / pivot)^2 of that.
void SubtractColumn(DoubleDouble* column, std::ptrdiff_t ld, int rows, double* noise) {
  const DoubleDouble inverse = Reciprocal(column[0]);
  for (int j = 1; j < rows; ++j) {
    const DoubleDouble factor = column[j] * inverse;
    noise[j] += factor.high * factor.high * noise[0];
    DoubleDouble* const other = column + j * ld;
    for (int i = j; i < rows; ++i) other[i] -= factor * column[i];
  }
}

}  // namespace

Definiteness EliminateExactly(DoubleDouble* F, int ld, int size, int pivots, double* noise,
                              double* panel) {
  Definiteness result = Definiteness::kDefinite;
  for (int c = 0; c < pivots; ++c, F += ld + 1, panel += ld + 1, ++noise) {
    const int rows = size - c;
    const double pivot = F[0].high;
    if (pivot > *noise) {
      const double root = std::sqrt(pivot);
      panel[0] = root;
      for (int i = 1; i < rows; ++i) panel[i] = F[i].high / root;
      SubtractColumn(F, ld, rows, noise);
    } else if (pivot >= -*noise) {
      panel[0] = kNoBound;
      for (int i = 1; i < rows; ++i) panel[i] = 0.0;
      result = Definiteness::kSemidefinite;
    } else {
      return Definiteness::kIndefinite;
    }
  }
  return result;
}

}  // namespace loopgrid
