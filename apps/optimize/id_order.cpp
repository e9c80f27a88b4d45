#include "apps/optimize/id_order.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <numeric>

namespace loopgrid {

IdOrder::IdOrder(const std::vector<std::int64_t>& ids) : rank_of_node_(ids.size()) {
  std::vector<std::size_t> nodes(ids.size());
  std::iota(nodes.begin(), nodes.end(), std::size_t{0});
  std::sort(nodes.begin(), nodes.end(),
            [&ids](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
  for (std::size_t rank = 0; rank < nodes.size(); ++rank) {
    rank_of_node_[nodes[rank]] = static_cast<int>(rank);
  }
}

bool IdOrder::AreConsecutive(int a, int b) const {
  const int rank_a = rank_of_node_[static_cast<std::size_t>(a)];
  const int rank_b = rank_of_node_[static_cast<std::size_t>(b)];
  return std::abs(rank_a - rank_b) == 1;
}

}  // namespace loopgrid
