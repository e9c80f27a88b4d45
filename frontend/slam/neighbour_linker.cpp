#include "frontend/slam/neighbour_linker.h"

#include <Eigen/Dense>
#include <cmath>
#include <cstdlib>

#include "frontend/slam/loop_closer.h"

namespace loopgrid {
namespace {

// The nearest node of each other pass by node i.
std::vector<int> NearestOfEachPass(const Nodes& nodes, int i,
                                   const NeighbourLinkerOptions& options) {
  std::vector<int> nearest;
  double nearest_distance = 0.0;
  int last = -1000000;
  for (int j = 0; j < nodes.size(); ++j) {
    if (std::abs(i - j) <= options.recent_nodes) continue;
    const double distance = (nodes.pose(j).translation() - nodes.pose(i).translation()).norm();
    if (distance > options.distance) continue;
    if (j - last > options.same_pass) {
      nearest.push_back(j);
      nearest_distance = distance;
    } else if (distance < nearest_distance) {
      nearest.back() = j;
      nearest_distance = distance;
    }
    last = j;
  }
  return nearest;
}

}  // namespace

std::vector<Constraint> LinkNeighbours(const Nodes& nodes, const NeighbourLinkerOptions& options) {
  std::vector<std::vector<int>> linked_to(static_cast<std::size_t>(nodes.size()));
  for (int i = 0; i < nodes.size(); ++i) {
    for (int j : NearestOfEachPass(nodes, i, options))
      linked_to[static_cast<std::size_t>(j)].push_back(i);
  }
  std::vector<Constraint> links;
  for (int j = 0; j < nodes.size(); ++j) {
    const std::vector<int>& others = linked_to[static_cast<std::size_t>(j)];
    if (others.empty()) continue;
    int first = j;
    while (first > 0 && nodes.PathLength(first - 1, j) <= options.map_path) --first;
    int last = j;
    while (last + 1 < nodes.size() && nodes.PathLength(j, last + 1) <= options.map_path) ++last;
    const LocalMap map = nodes.MapOf(first, last, j, options.map_radius);
    for (int i : others) {
      if (i >= first && i <= last) continue;
      const SE2 predicted = nodes.Between(j, i);
      const RefinedMatch match = RefineMatch(map, nodes.scan(i), predicted,
                                             {predicted, Eigen::Matrix3d::Zero()}, options.refiner);
      const SE2 shift = predicted.Inverse() * match.T_map_robot;
      if (match.inlier_share < options.min_inlier_share) continue;
      if (shift.translation().norm() > options.max_shift) continue;
      if (std::abs(shift.theta()) > options.max_turn) continue;
      links.push_back({j, i, match.T_map_robot,
                       (match.information.inverse() +
                        Eigen::Matrix3d(Eigen::Vector3d(1e-4, 1e-4, 1.2e-5).asDiagonal()))
                           .inverse(),
                       true});
    }
  }
  return links;
}

}  // namespace loopgrid
