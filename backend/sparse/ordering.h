#pragma once

#include <span>
#include <vector>

#include "backend/sparse/symmetric_block_matrix.h"

namespace loopgrid {

/// Orders of elimination that keep the factor of a sparse symmetric n x n matrix sparse, given the
/// places of its entries above the diagonal: order[k] is the column that is eliminated k-th.

/// Approximate minimum degree (Amestoy, Davis and Duff 1996): fast, and good for graphs that are
/// nearly chains.
std::vector<int> MinimumDegreeOrder(int n, std::span<const BlockPlace> places);

/// Nested dissection (George 1973) by METIS's multilevel partitioning (Karypis and Kumar 1998): ten
/// times slower, but better for large graphs that fill an area. METIS uses the C library's rand().
/// It gets a sequence of its own here, so that the order is reproducible and the program's sequence
/// is not disturbed, as long as no other thread calls rand() at the same time.
std::vector<int> NestedDissectionOrder(int n, std::span<const BlockPlace> places);

}  // namespace loopgrid
