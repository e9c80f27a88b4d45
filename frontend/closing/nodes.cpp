#include "frontend/closing/nodes.h"

#include <algorithm>

namespace loopgrid {

double Nodes::StepLength(int node) const {
  if (const auto gap = gaps.find(node + 1); gap != gaps.end()) return gap->second;
  return (pose(node + 1).translation() - pose(node).translation()).norm();
}

double Nodes::PathLength(int a, int b) const {
  double length = 0.0;
  for (int k = std::min(a, b); k < std::max(a, b); ++k) {
    length += StepLength(k);
  }
  return length;
}

NodeRange Nodes::Around(int node, double path) const {
  NodeRange range{node, node};
  for (double length = 0.0; range.first > 0; --range.first) {
    length += StepLength(range.first - 1);
    if (length > path) break;
  }
  for (double length = 0.0; range.last + 1 < size(); ++range.last) {
    length += StepLength(range.last);
    if (length > path) break;
  }
  return range;
}

LocalMap Nodes::MapOf(const NodeRange& range, int origin, double radius) const {
  std::vector<PlacedScan> placed;
  const SE2 T_origin_map = pose(origin).Inverse();
  for (int k = range.first; k <= range.last; ++k) {
    placed.push_back({&scan(k), T_origin_map * pose(k)});
  }
  return LocalMap(placed, Eigen::Vector2d::Zero(), radius);
}

}  // namespace loopgrid
