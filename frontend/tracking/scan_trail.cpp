#include "frontend/tracking/scan_trail.h"

#include <algorithm>

namespace loopgrid {

void ScanTrail::AddNode(int parent, const SE2& T_parent_node, int first_scan) {
  node_scans_.push_back(size() - 1);
  ways_.push_back({parent, T_parent_node, first_scan});
}

SE2 ScanTrail::Pose(int scan, const PoseGraph<SE2>& graph) const {
  const ScanPlace& place = (*this)[scan].place;
  const SE2& node = graph.poses[static_cast<std::size_t>(place.node)];
  const auto after = std::upper_bound(node_scans_.begin(), node_scans_.end(), scan);
  if (after == node_scans_.end()) return node * place.T_node_robot;
  const auto next = static_cast<std::size_t>(after - node_scans_.begin());
  const Way& way = ways_[next];
  if (way.parent != place.node || scan < way.first_scan) return node * place.T_node_robot;
  const double share = static_cast<double>(scan - way.first_scan) / (*after - way.first_scan);
  const SE2 change = way.T_parent_node.Inverse() * (node.Inverse() * graph.poses[next]);
  return node * place.T_node_robot * SE2::Exp(share * change.Log());
}

}  // namespace loopgrid
