#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "backend/base/index.h"
#include "backend/sparse/symmetric_block_matrix.h"

namespace loopgrid {

/// The structure of the Cholesky factor of a sparse symmetric matrix (here: of blocks), in
/// elimination order, with columns of (nearly) equal structure gathered into supernodes. Supernode
/// s eliminates columns [first_column[s], first_column[s + 1]); with its row indices they span the
/// dense front that the numeric factorisation works on.
struct SymbolicFactor {
  std::vector<int> order;     ///< order[k]: the column of the matrix that is eliminated k-th
  std::vector<int> position;  ///< its inverse
  std::size_t entries = 0;    ///< below the factor's diagonal, without the zeros in supernodes

  std::vector<int> first_column;       ///< per supernode, and the number of columns at the end
  std::vector<int> parent;             ///< supernode that takes a supernode's update, -1 for a root
  std::vector<std::size_t> first_row;  ///< per supernode: its range in `rows`, `row_in_parent`
  std::vector<int> rows;               ///< rows below the supernode's own columns, ascending
  std::vector<int> row_in_parent;      ///< their positions in the parent's front

  int supernode_count() const { return static_cast<int>(parent.size()); }
  int columns(int s) const { return first_column[ToIndex(s) + 1] - first_column[ToIndex(s)]; }
  int row_count(int s) const {
    return static_cast<int>(first_row[ToIndex(s) + 1] - first_row[ToIndex(s)]);
  }
  /// Products of blocks that the numeric factorisation computes.
  double Operations() const;
  /// Position of an elimination index in the front of supernode s; it must be in it.
  int PositionInFront(int s, int index) const;
};

/// Analyses the factor for an order of elimination. Changes the order, without more fill, so that
/// the columns of each supernode are contiguous.
SymbolicFactor AnalyzeFactor(std::vector<int> order, std::span<const BlockPlace> places);

}  // namespace loopgrid
