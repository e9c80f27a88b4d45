#pragma once

#include <cstdint>
#include <vector>

namespace loopgrid {

/// The nodes of a graph in the order of their ids, which is that of the robot's way.
class IdOrder {
 public:
  explicit IdOrder(const std::vector<std::int64_t>& ids);

  /// Whether no other id is between those of two nodes.
  bool AreConsecutive(int a, int b) const;

 private:
  std::vector<int> rank_of_node_;
};

}  // namespace loopgrid
