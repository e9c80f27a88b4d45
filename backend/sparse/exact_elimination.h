#pragma once

#include "backend/sparse/double_double.h"

namespace loopgrid {

enum class Definiteness {
  kDefinite,
  kSemidefinite,  ///< singular, but no direction has a negative square
  kIndefinite,
};

/// EliminateColumns with twice the digits. The columns of the factor, rounded, go to `panel`, which
/// has the leading dimension of F; the Schur complement stays in F. `noise` has, for each row, how
/// wrong its diagonal entry may be; for the rows below the pivots it grows by what elimination
/// adds. A pivot within the noise is taken for zero, and its column gets an infinite pivot:
/// solutions have a zero there. If it is more negative, the matrix is indefinite, and the rest is
/// left undone.
[[nodiscard]] Definiteness EliminateExactly(DoubleDouble* F, int ld, int size, int pivots,
                                            double* noise, double* panel);

}  // namespace loopgrid
