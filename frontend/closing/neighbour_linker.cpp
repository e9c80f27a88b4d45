#include "frontend/closing/neighbour_linker.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace loopgrid {
namespace {

// The other ends of each node's closures.
std::vector<std::vector<int>> ClosuresOf(const Nodes& nodes) {
  std::vector<std::vector<int>> others(static_cast<std::size_t>(nodes.size()));
  for (const Constraint<SE2>& c : nodes.graph->constraints) {
    if (!c.robust) continue;
    others[static_cast<std::size_t>(c.from)].push_back(c.to);
    others[static_cast<std::size_t>(c.to)].push_back(c.from);
  }
  return others;
}

// The nearest node of each other pass near node i.
std::vector<int> NearestOfEachPass(const Nodes& nodes, int i,
                                   const NeighbourLinkerOptions& options) {
  std::vector<int> nearest;
  double nearest_distance = 0.0;
  int last = -1 - options.same_pass;
  for (int j = 0; j < nodes.size(); ++j) {
    if (std::abs(i - j) <= options.same_pass) continue;
    const double distance = (nodes.pose(j).translation() - nodes.pose(i).translation()).norm();
    if (distance > options.distance) continue;
    if (j - last > options.same_pass || nearest.empty()) {
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

bool IsBelievable(const ClosureMatch& match, const SE2& predicted,
                  const NeighbourLinkerOptions& options) {
  if (!match.found || match.denied_share > options.max_denied_share) return false;
  const SE2 shift = predicted.Inverse() * match.T_map_robot;
  return shift.translation().norm() <= options.max_shift &&
         std::abs(shift.theta()) <= options.max_turn;
}

}  // namespace

std::vector<Constraint<SE2>> LinkNeighbours(const Nodes& nodes,
                                            const NeighbourLinkerOptions& options) {
  // Grouped by the node whose map is used, so that each map is made once.
  const std::vector<std::vector<int>> closures = ClosuresOf(nodes);
  std::vector<std::vector<int>> scans_for_map(static_cast<std::size_t>(nodes.size()));
  for (int i = 0; i < nodes.size(); ++i) {
    for (int j : NearestOfEachPass(nodes, i, options)) {
      const auto& linked = closures[static_cast<std::size_t>(i)];
      const bool spared = std::any_of(linked.begin(), linked.end(), [&](int other) {
        return std::abs(other - j) <= options.already_linked;
      });
      if (!spared) scans_for_map[static_cast<std::size_t>(j)].push_back(i);
    }
  }
  std::vector<Constraint<SE2>> links;
  for (int j = 0; j < nodes.size(); ++j) {
    const std::vector<int>& others = scans_for_map[static_cast<std::size_t>(j)];
    if (others.empty()) continue;
    const NodeRange range = nodes.Around(j, options.map_path);
    const LocalMap map = nodes.MapOf(range, j, options.map_radius);
    for (int i : others) {
      if (i >= range.first && i <= range.last) continue;
      const SE2 predicted = nodes.Between(j, i);
      const PointScan& scan = nodes.scan(i);
      const ClosureMatch match =
          MatchClosure(map, scan, scan.hits, predicted, options.window, options.matcher);
      if (!IsBelievable(match, predicted, options)) continue;
      links.push_back({j, i, match.T_map_robot, match.covariance.inverse(), true});
    }
  }
  return links;
}

}  // namespace loopgrid
