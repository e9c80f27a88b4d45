#pragma once

#include <cstdint>
#include <vector>

namespace loopgrid {

/// The nodes of a graph in the order of their ids. The robot made them in this order.
class IdOrder {
 public:
  explicit IdOrder(const std::vector<std::int64_t>& ids);

  /// Whether one of two nodes follows the other in this order.
  bool AreConsecutive(int a, int b) const;

 private:
  std::vector<int> rank_of_node_;
};

}  // namespace loopgrid
