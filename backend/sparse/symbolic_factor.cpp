#include "backend/sparse/symbolic_factor.h"

#include "backend/base/index.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace loopgrid {
namespace {

/// Lists of rows, one a column, in one array.
struct ColumnLists {
  std::vector<int> start;
  std::vector<int> rows;

  std::span<const int> operator[](int col) const {
    return {rows.data() + start[ToIndex(col)], rows.data() + start[ToIndex(col) + 1]};
  }
};

std::vector<int> Inverse(const std::vector<int>& permutation) {
  std::vector<int> inverse(permutation.size());
  for (int k = 0; k < static_cast<int>(permutation.size()); ++k) {
    inverse[ToIndex(permutation[ToIndex(k)])] = k;
  }
  return inverse;
}

/// The strict upper triangle, columns and rows renumbered by `position`.
ColumnLists UpperTriangle(std::span<const BlockPlace> places, const std::vector<int>& position) {
  ColumnLists lists;
  lists.start.assign(position.size() + 1, 0);
  for (const BlockPlace& place : places) {
    ++lists
          .start[ToIndex(std::max(position[ToIndex(place.row)], position[ToIndex(place.col)])) + 1];
  }
  std::partial_sum(lists.start.begin(), lists.start.end(), lists.start.begin());
  lists.rows.resize(places.size());
  std::vector<int> next(lists.start.begin(), lists.start.end() - 1);
  for (const BlockPlace& place : places) {
    const auto [low, high] =
        std::minmax({position[ToIndex(place.row)], position[ToIndex(place.col)]});
    lists.rows[ToIndex(next[ToIndex(high)]++)] = low;
  }
  return lists;
}

/// Elimination tree (Liu 1990): the parent of column j is the first row below j in the factor.
std::vector<int> EliminationTree(const ColumnLists& upper) {
  const int n = static_cast<int>(upper.start.size()) - 1;
  std::vector<int> parent(ToIndex(n), -1);
  std::vector<int> ancestor(ToIndex(n), -1);
  for (int j = 0; j < n; ++j) {
    for (int i : upper[j]) {
      while (i != -1 && i < j) {
        const int next = ancestor[ToIndex(i)];
        ancestor[ToIndex(i)] = j;
        if (next == -1) parent[ToIndex(i)] = j;
        i = next;
      }
    }
  }
  return parent;
}

/// Children before parents, each subtree contiguous: result[k] is the k-th node visited.
std::vector<int> Postorder(const std::vector<int>& parent) {
  const int n = static_cast<int>(parent.size());
  std::vector<int> first_child(ToIndex(n), -1);
  std::vector<int> sibling(ToIndex(n), -1);
  std::vector<int> stack;
  for (int j = n - 1; j >= 0; --j) {
    const int up = parent[ToIndex(j)];
    if (up == -1) continue;
    sibling[ToIndex(j)] = first_child[ToIndex(up)];
    first_child[ToIndex(up)] = j;
  }
  std::vector<int> order;
  order.reserve(ToIndex(n));
  for (int root = 0; root < n; ++root) {
    if (parent[ToIndex(root)] != -1) continue;
    stack.push_back(root);
    while (!stack.empty()) {
      const int node = stack.back();
      const int child = first_child[ToIndex(node)];
      if (child != -1) {
        first_child[ToIndex(node)] = sibling[ToIndex(child)];
        stack.push_back(child);
      } else {
        order.push_back(node);
        stack.pop_back();
      }
    }
  }
  return order;
}

/// Calls visit(column, row) for each entry of the factor below the diagonal, rows ascending: row i
/// has an entry in each column on the tree paths from the columns of upper[i] towards i.
template <typename Visit>
void ForEachFactorEntry(const ColumnLists& upper, const std::vector<int>& parent,
                        const Visit& visit) {
  const int n = static_cast<int>(parent.size());
  std::vector<int> mark(ToIndex(n), -1);
  for (int i = 0; i < n; ++i) {
    mark[ToIndex(i)] = i;
    for (int j : upper[i]) {
      for (; mark[ToIndex(j)] != i; j = parent[ToIndex(j)]) {
        mark[ToIndex(j)] = i;
        visit(j, i);
      }
    }
  }
}

/// A run of columns that are eliminated together.
struct Group {
  int first;
  int last;
  double zeros;  // entries of the panel that the factor does not have
};

/// Whether a child should join its parent: small dense panels are faster than the sum of smaller
/// ones, as long as few zeros are computed with.
bool WorthMerging(int columns, double zeros, double entries) {
  if (columns <= 2) return true;
  if (columns <= 6) return zeros < 0.4 * entries;
  if (columns <= 16) return zeros < 0.1 * entries;
  return zeros < 0.05 * entries;
}

/// First columns of the supernodes, and the number of columns at the end.
std::vector<int> FindSupernodes(const std::vector<int>& parent, const std::vector<int>& counts) {
  const int n = static_cast<int>(parent.size());
  std::vector<Group> groups;
  for (int j = 0; j < n; ++j) {
    Group group{j, j, 0.0};
    // In a postordering the column before j is its last child, or j has none.
    while (!groups.empty() && parent[ToIndex(groups.back().last)] <= j &&
           parent[ToIndex(groups.back().last)] != -1) {
      const Group& child = groups.back();
      const int width = j - child.first + 1;
      const double below = counts[ToIndex(j)];
      const double added =
          (child.last - child.first + 1) * (j - child.last + below - counts[ToIndex(child.last)]);
      const double zeros = group.zeros + child.zeros + added;
      const double entries = 0.5 * width * (width + 1) + width * below;
      if (added > 0.0 && !WorthMerging(width, zeros, entries)) break;
      group = {child.first, j, zeros};
      groups.pop_back();
    }
    groups.push_back(group);
  }
  std::vector<int> first;
  first.reserve(groups.size() + 1);
  for (const Group& group : groups) first.push_back(group.first);
  first.push_back(n);
  return first;
}

/// The rows of a supernode are those of its last column.
void ListRows(const ColumnLists& upper, const std::vector<int>& tree,
              const std::vector<int>& counts, SymbolicFactor* factor) {
  constexpr std::size_t kNotLast = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> next(counts.size(), kNotLast);  // where a column's next row goes
  factor->first_row = {0};
  for (std::size_t s = 0; s + 1 < factor->first_column.size(); ++s) {
    const int last = factor->first_column[s + 1] - 1;
    next[ToIndex(last)] = factor->first_row.back();
    factor->first_row.push_back(factor->first_row.back() + ToIndex(counts[ToIndex(last)]));
  }
  factor->rows.resize(factor->first_row.back());
  ForEachFactorEntry(upper, tree, [&](int col, int row) {
    if (next[ToIndex(col)] != kNotLast) factor->rows[next[ToIndex(col)]++] = row;
  });
}

/// Finds the supernode that takes each supernode's update, and where in its front.
void ConnectSupernodes(const std::vector<int>& tree, SymbolicFactor* factor) {
  std::vector<int> supernode_of(tree.size());
  const int count = static_cast<int>(factor->first_column.size()) - 1;
  for (int s = 0; s < count; ++s) {
    const int end = factor->first_column[ToIndex(s) + 1];
    for (int k = factor->first_column[ToIndex(s)]; k < end; ++k) supernode_of[ToIndex(k)] = s;
  }
  factor->parent.resize(ToIndex(count));
  factor->row_in_parent.resize(factor->rows.size());
  for (int s = 0; s < count; ++s) {
    const int up = tree[ToIndex(factor->first_column[ToIndex(s) + 1] - 1)];
    const int parent = up == -1 ? -1 : supernode_of[ToIndex(up)];
    factor->parent[ToIndex(s)] = parent;
    for (std::size_t k = factor->first_row[ToIndex(s)]; k < factor->first_row[ToIndex(s) + 1];
         ++k) {
      factor->row_in_parent[k] = factor->PositionInFront(parent, factor->rows[k]);
    }
  }
}

}  // namespace

int SymbolicFactor::PositionInFront(int s, int index) const {
  const int first = first_column[ToIndex(s)];
  const int width = columns(s);
  if (index < first + width) return index - first;
  const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(first_row[ToIndex(s)]);
  const auto end = rows.begin() + static_cast<std::ptrdiff_t>(first_row[ToIndex(s) + 1]);
  return width + static_cast<int>(std::lower_bound(begin, end, index) - begin);
}

double SymbolicFactor::Operations() const {
  double sum = 0.0;
  for (int s = 0; s < supernode_count(); ++s) {
    for (int k = 0; k < columns(s); ++k) {
      const double below = columns(s) - k + row_count(s);
      sum += below * below;
    }
  }
  return sum;
}

SymbolicFactor AnalyzeFactor(std::vector<int> order, std::span<const BlockPlace> places) {
  SymbolicFactor factor;
  const std::vector<int> visits = Postorder(EliminationTree(UpperTriangle(places, Inverse(order))));
  for (int visit : visits) factor.order.push_back(order[ToIndex(visit)]);
  factor.position = Inverse(factor.order);

  const ColumnLists upper = UpperTriangle(places, factor.position);
  const std::vector<int> tree = EliminationTree(upper);
  std::vector<int> counts(order.size(), 0);
  ForEachFactorEntry(upper, tree, [&](int col, int) { ++counts[ToIndex(col)]; });
  factor.entries = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  factor.first_column = FindSupernodes(tree, counts);
  ListRows(upper, tree, counts, &factor);
  ConnectSupernodes(tree, &factor);
  return factor;
}

}  // namespace loopgrid
