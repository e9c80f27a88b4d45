#include "frontend/closing/place_finder.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace loopgrid {

PlaceFinder::PlaceFinder(const Nodes& nodes, int count, const PlaceFinderOptions& options)
    : options_(options) {
  std::vector<PlacedScan> placed;
  for (int k = 0; k < count; ++k) {
    const SE2& pose = nodes.pose(k);
    nodes_.push_back(pose);
    placed.push_back({&nodes.scan(k), pose});
    const bool covered = std::any_of(centers_.begin(), centers_.end(), [&](const SE2& center) {
      return (center.translation() - pose.translation()).norm() < options_.spacing;
    });
    if (!covered) centers_.emplace_back(pose.x(), pose.y(), 0.0);
  }
  map_ = LocalMap(placed, Eigen::Vector2d::Zero(), std::numeric_limits<double>::infinity());
}

int PlaceFinder::NearestNode(const SE2& T_map_robot) const {
  const auto distance = [&](const SE2& node) {
    return (node.translation() - T_map_robot.translation()).squaredNorm();
  };
  const auto nearest =
      std::min_element(nodes_.begin(), nodes_.end(),
                       [&](const SE2& a, const SE2& b) { return distance(a) < distance(b); });
  return static_cast<int>(nearest - nodes_.begin());
}

std::optional<FoundPlace> PlaceFinder::Find(const PointScan& scan,
                                            std::span<const Eigen::Vector2f> surroundings,
                                            const ClosureMatcherOptions& options) const {
  const SearchWindow window{options_.half_width, options_.half_width, std::numbers::pi};
  ClosureMatcherOptions limits = options;
  limits.min_inlier_share = options_.min_inlier_share;
  ClosureMatch best;
  for (const SE2& center : centers_) {
    limits.min_score = std::max(options_.min_score, options_.min_share * best.score);
    const ClosureMatch match = MatchClosure(map_, scan, surroundings, center, window, limits);
    if (!match.found) continue;
    const bool better = !best.found || match.score > best.score;
    const ClosureMatch& lesser = better ? best : match;
    const bool same_place =
        best.found && (match.T_map_robot.translation() - best.T_map_robot.translation()).norm() <
                          options_.peak_distance;
    const double other =
        std::max({best.second_score, match.second_score, same_place ? 0.0 : lesser.score});
    if (better) best = match;
    best.second_score = other;
  }
  if (!best.found) return std::nullopt;
  const int node = NearestNode(best.T_map_robot);
  best.T_map_robot = nodes_[static_cast<std::size_t>(node)].Inverse() * best.T_map_robot;
  return FoundPlace{node, best};
}

}  // namespace loopgrid
