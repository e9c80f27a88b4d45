#include "backend/sparse/ordering.h"

#include "backend/base/index.h"

#include <amd.h>
#include <metis.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <mutex>
#include <new>
#include <numeric>
#include <vector>

namespace loopgrid {
namespace {

/// The neighbours of each node, in one array: those of node i in [start[i], start[i + 1]).
struct Neighbours {
  std::vector<int> start;
  std::vector<int> nodes;
};

Neighbours ListNeighbours(int n, std::span<const BlockPlace> places) {
  Neighbours lists;
  lists.start.assign(ToIndex(n) + 1, 0);
  for (const BlockPlace& place : places) {
    ++lists.start[ToIndex(place.row) + 1];
    ++lists.start[ToIndex(place.col) + 1];
  }
  std::partial_sum(lists.start.begin(), lists.start.end(), lists.start.begin());
  lists.nodes.resize(2 * places.size());
  std::vector<int> next(lists.start.begin(), lists.start.end() - 1);
  for (const BlockPlace& place : places) {
    lists.nodes[ToIndex(next[ToIndex(place.row)]++)] = place.col;
    lists.nodes[ToIndex(next[ToIndex(place.col)]++)] = place.row;
  }
  return lists;
}

/// For as long as it lives, the C library's rand() and srand() work on a sequence of their own: the
/// program's goes on afterwards as if nothing had been. METIS begins with srand(). Another thread
/// that calls rand() at the same time disturbs METIS, and gets METIS's numbers.
class PrivateRandomSequence {
 public:
  PrivateRandomSequence() : lock_(mutex_), outside_(initstate(1, state_.data(), state_.size())) {}
  ~PrivateRandomSequence() { setstate(outside_); }
  PrivateRandomSequence(const PrivateRandomSequence&) = delete;
  PrivateRandomSequence& operator=(const PrivateRandomSequence&) = delete;

 private:
  static inline std::mutex mutex_;
  const std::lock_guard<std::mutex> lock_;
  std::array<char, 128> state_{};  // the size that selects rand()'s usual generator
  char* outside_;
};

}  // namespace

std::vector<int> MinimumDegreeOrder(int n, std::span<const BlockPlace> places) {
  std::vector<int> order(ToIndex(n));
  std::iota(order.begin(), order.end(), 0);
  if (places.empty()) return order;  // AMD and METIS take no graph without edges
  const Neighbours lists = ListNeighbours(n, places);
  const int status =
      amd_order(n, lists.start.data(), lists.nodes.data(), order.data(), nullptr, nullptr);
  if (status == AMD_OUT_OF_MEMORY) throw std::bad_alloc();
  return order;
}

std::vector<int> NestedDissectionOrder(int n, std::span<const BlockPlace> places) {
  static_assert(sizeof(idx_t) == sizeof(int));
  std::vector<int> order(ToIndex(n));
  std::iota(order.begin(), order.end(), 0);
  if (places.empty()) return order;
  Neighbours lists = ListNeighbours(n, places);
  std::vector<int> position(ToIndex(n));
  const PrivateRandomSequence sequence;
  const int status = METIS_NodeND(&n, lists.start.data(), lists.nodes.data(), nullptr, nullptr,
                                  order.data(), position.data());
  if (status != METIS_OK) throw std::bad_alloc();
  return order;
}

}  // namespace loopgrid
