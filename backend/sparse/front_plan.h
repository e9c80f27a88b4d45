#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "backend/base/index.h"
#include "backend/sparse/symbolic_factor.h"
#include "backend/sparse/symmetric_block_matrix.h"

namespace loopgrid {

/// The part of a multifrontal factorisation of a sparse matrix of dense blocks that depends only on
/// the matrix's pattern: the order of elimination, the blocks of the matrix that make up each
/// supernode's dense front, and the places of the results in memory. Sizes and places count
/// numbers, not blocks. Columns of fronts are PaddedRows apart.
class FrontPlan {
 public:
  /// A block of the matrix below the diagonal and where it goes in its supernode's front.
  struct Source {
    int block;
    int front_row;
    int front_col;
    bool transposed;
  };

  /// `dim`: rows of a block.
  explicit FrontPlan(int dim) : dim_(dim) {}

  /// Orders the block columns (minimum degree, for large matrices nested dissection too) and plans.
  /// For a matrix that has grown since the last call, the order is kept and new columns come last,
  /// as long as this costs little fill.
  void Analyze(int cols, std::span<const BlockPlace> places);

  const SymbolicFactor& structure() const { return structure_; }

  std::span<const Source> sources(int s) const {
    return {sources_.data() + first_source_[ToIndex(s)],
            sources_.data() + first_source_[ToIndex(s) + 1]};
  }

  /// The last child of a supernode in elimination order, and the sibling before a child; -1 if
  /// there is none.
  int last_child(int s) const { return last_child_[ToIndex(s)]; }
  int sibling(int s) const { return sibling_[ToIndex(s)]; }

  int front_size(int s) const { return dim_ * (structure_.columns(s) + structure_.row_count(s)); }
  int pivots(int s) const { return dim_ * structure_.columns(s); }

  /// Where the supernode's columns begin in the array of the factor.
  std::size_t panel_start(int s) const { return panel_start_[ToIndex(s)]; }
  std::size_t panels_size() const { return panel_start_.back(); }

  /// Where the supernode's update begins on the stack of updates. An update is the Schur complement
  /// that elimination leaves for the parent supernode.
  std::size_t update_start(int s) const { return update_start_[ToIndex(s)]; }
  std::size_t updates_size() const { return updates_size_; }

  int largest_front() const { return largest_front_; }

 private:
  bool KeepOrder(int cols, std::span<const BlockPlace> places);
  void ListChildren();
  void PlaceSources(std::span<const BlockPlace> places);
  void PlaceMemory();

  int dim_;
  SymbolicFactor structure_;
  double ordered_fill_ = 0.0;    // entries of the factor per block when its order was found
  std::vector<Source> sources_;  // by supernode
  std::vector<std::size_t> first_source_;  // per supernode, and the end
  std::vector<int> last_child_;
  std::vector<int> sibling_;
  std::vector<std::size_t> panel_start_;  // per supernode, and the end
  std::vector<std::size_t> update_start_;
  std::size_t updates_size_ = 0;
  int largest_front_ = 0;
};

}  // namespace loopgrid
