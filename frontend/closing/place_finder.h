#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "frontend/closing/closure_matcher.h"
#include "frontend/closing/nodes.h"

namespace loopgrid {

struct PlaceFinderOptions {
  double spacing = 5.0;        ///< between the middles of the windows searched, metres
  double half_width = 7.0;     ///< of such a window: the robot may be off the nodes' way, metres
  double peak_distance = 0.8;  ///< two finds this close are the same place, metres
  double min_score = 0.65;     ///< of the search, 0..1: rooms are alike, nothing else tells
  double min_inlier_share = 0.75;  ///< of the refined match, 0..1
  double min_share = 0.85;         ///< of the best score, for a place to matter
};

/// A place in the map where a scan fits.
struct FoundPlace {
  int node = 0;        ///< the nearest node
  ClosureMatch match;  ///< `T_map_robot` is relative to that node
};

/// Finds a robot that can be anywhere in a map, whichever way it looks.
class PlaceFinder {
 public:
  /// The map is that of the first `count` nodes, where they are now.
  PlaceFinder(const Nodes& nodes, int count, const PlaceFinderOptions& options = {});

  /// How many windows a search goes through.
  int places() const { return static_cast<int>(centers_.size()); }

  /// The best place for `scan`, `surroundings` as in MatchClosure(), both in the robot frame. The
  /// second score is that of the best other place. Nothing if no place reaches the scores.
  std::optional<FoundPlace> Find(const PointScan& scan,
                                 std::span<const Eigen::Vector2f> surroundings,
                                 const ClosureMatcherOptions& options) const;

 private:
  int NearestNode(const SE2& T_map_robot) const;

  PlaceFinderOptions options_;
  std::vector<SE2> nodes_;    // T_map_node
  std::vector<SE2> centers_;  // of the windows
  LocalMap map_;              // in the map frame
};

}  // namespace loopgrid
