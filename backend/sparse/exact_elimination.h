#pragma once

#include "backend/sparse/double_double.h"

namespace loopgrid {

enum class Definiteness {
  kDefinite,
  kSemidefinite,  ///< singular, but no direction has a negative square
  kIndefinite,
};

/// EliminateColumns with twice the digits. The columns of the factor, rounded to double, go to
/// `panel`, which has the leading dimension of F; the Schur complement stays in F.
///
/// noise[i] is a bound on the error of the diagonal entry of row i. Elimination increases it for
/// the rows that remain. A pivot that is not larger than its noise is taken for zero: its column in
/// the panel gets an infinite pivot and zeros below, so that solutions have a zero there. If a
/// pivot is below minus its noise, the matrix is indefinite and elimination stops.
[[nodiscard]] Definiteness EliminateExactly(DoubleDouble* F, int ld, int size, int pivots,
                                            double* noise, double* panel);

}  // namespace loopgrid
