#include "backend/sparse/front_plan.h"

#include <algorithm>
#include <utility>

#include "backend/base/index.h"
#include "backend/sparse/frontal_kernels.h"
#include "backend/sparse/ordering.h"

namespace loopgrid {
namespace {

/// When the factor has this many times the entries per block of the matrix that it had when the
/// order was found, a new order is worth its time.
constexpr double kWorthOrdering = 1.2;

/// Multiplications in the factorisation per column and end of an off-diagonal block from which on
/// the better order of nested dissection pays for its own time, within a few factorisations.
constexpr double kWorthDissecting = 1e4;

/// Entries of the factor per block of the matrix.
double Fill(const SymbolicFactor& factor, std::size_t blocks) {
  return static_cast<double>(factor.entries) /
         static_cast<double>(std::max<std::size_t>(1, blocks));
}

}  // namespace

void FrontPlan::Analyze(int cols, std::span<const BlockPlace> places) {
  if (!KeepOrder(cols, places)) {
    structure_ = AnalyzeFactor(MinimumDegreeOrder(cols, places), places);
    const double ends = cols + 2.0 * static_cast<double>(places.size());
    if (dim_ * dim_ * dim_ * structure_.Operations() > kWorthDissecting * ends) {
      SymbolicFactor other = AnalyzeFactor(NestedDissectionOrder(cols, places), places);
      if (other.Operations() < structure_.Operations()) structure_ = std::move(other);
    }
    ordered_fill_ = Fill(structure_, places.size());
  }
  ListChildren();
  PlaceSources(places);
  PlaceMemory();
}

bool FrontPlan::KeepOrder(int cols, std::span<const BlockPlace> places) {
  std::vector<int> order = structure_.order;
  if (order.empty() || cols < static_cast<int>(order.size())) return false;
  while (static_cast<int>(order.size()) < cols) order.push_back(static_cast<int>(order.size()));
  SymbolicFactor kept = AnalyzeFactor(std::move(order), places);
  if (Fill(kept, places.size()) > kWorthOrdering * ordered_fill_) return false;
  structure_ = std::move(kept);
  return true;
}

void FrontPlan::ListChildren() {
  const int count = structure_.supernode_count();
  last_child_.assign(ToIndex(count), -1);
  sibling_.assign(ToIndex(count), -1);
  for (int s = 0; s < count; ++s) {
    const int parent = structure_.parent[ToIndex(s)];
    if (parent == -1) continue;
    sibling_[ToIndex(s)] = last_child_[ToIndex(parent)];
    last_child_[ToIndex(parent)] = s;
  }
}

void FrontPlan::PlaceSources(std::span<const BlockPlace> places) {
  const int count = structure_.supernode_count();
  std::vector<int> supernode_of(structure_.order.size());
  for (int s = 0; s < count; ++s) {
    for (int k = structure_.first_column[ToIndex(s)]; k < structure_.first_column[ToIndex(s) + 1];
         ++k) {
      supernode_of[ToIndex(k)] = s;
    }
  }
  // Counting sort of the blocks by the supernode that eliminates their column.
  first_source_.assign(ToIndex(count) + 1, 0);
  const auto supernode_at = [&](const BlockPlace& place) {
    return supernode_of[ToIndex(std::min(structure_.position[ToIndex(place.row)],
                                         structure_.position[ToIndex(place.col)]))];
  };
  for (const BlockPlace& place : places) ++first_source_[ToIndex(supernode_at(place)) + 1];
  for (int s = 0; s < count; ++s) first_source_[ToIndex(s) + 1] += first_source_[ToIndex(s)];
  sources_.resize(places.size());
  std::vector<std::size_t> next(first_source_.begin(), first_source_.end() - 1);
  for (int block = 0; block < static_cast<int>(places.size()); ++block) {
    const BlockPlace& place = places[ToIndex(block)];
    const int a = structure_.position[ToIndex(place.row)];
    const int b = structure_.position[ToIndex(place.col)];
    const int s = supernode_at(place);
    sources_[next[ToIndex(s)]++] = {block, structure_.PositionInFront(s, std::max(a, b)),
                                    std::min(a, b) - structure_.first_column[ToIndex(s)], a < b};
  }
}

void FrontPlan::PlaceMemory() {
  const int count = structure_.supernode_count();
  panel_start_.assign(ToIndex(count) + 1, 0);
  update_start_.assign(ToIndex(count), 0);
  updates_size_ = 0;
  largest_front_ = 0;
  std::size_t stack_top = 0;
  for (int s = 0; s < count; ++s) {
    const int size = front_size(s);
    panel_start_[ToIndex(s) + 1] = panel_start_[ToIndex(s)] + PaddedArea(size, pivots(s));
    largest_front_ = std::max(largest_front_, size);
    for (int child = last_child(s); child != -1; child = sibling(child)) {
      stack_top = update_start_[ToIndex(child)];
    }
    const int below = size - pivots(s);
    update_start_[ToIndex(s)] = stack_top;
    stack_top += PaddedArea(below, below);
    updates_size_ = std::max(updates_size_, stack_top);
  }
}

}  // namespace loopgrid
