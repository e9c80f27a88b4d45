#include "frontend/slam/nodes.h"

#include <algorithm>

namespace loopgrid {

double Nodes::PathLength(int a, int b) const {
  double length = 0.0;
  for (int k = std::min(a, b); k < std::max(a, b); ++k) {
    length += (pose(k + 1).translation() - pose(k).translation()).norm();
  }
  return length;
}

LocalMap Nodes::MapOf(int first, int last, int origin, double radius) const {
  std::vector<PlacedScan> placed;
  const SE2 T_origin_map = pose(origin).Inverse();
  for (int k = first; k <= last; ++k) placed.push_back({&scan(k), T_origin_map * pose(k)});
  return LocalMap(placed, Eigen::Vector2d::Zero(), radius);
}

}  // namespace loopgrid
