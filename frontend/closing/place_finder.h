#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "frontend/closing/closing_options.h"
#include "frontend/closing/closure_matcher.h"
#include "frontend/closing/nodes.h"

namespace loopgrid {

/// A place in the map where a scan fits.
struct FoundPlace {
  int node = 0;        ///< the nearest node
  ClosureMatch match;  ///< `T_map_robot` is relative to that node
};

/// Finds a robot that can be anywhere in a map and have any orientation.
class PlaceFinder {
 public:
  /// The map is made of the first `count` nodes at their present poses.
  PlaceFinder(const Nodes& nodes, int count, const PlaceFinderOptions& options = {});

  /// Number of windows that a search goes through.
  int places() const { return static_cast<int>(centers_.size()); }

  /// The best place for `scan`, `surroundings` as in MatchClosure(), both in the robot frame. The
  /// second score is that of the best other place. Nothing if no place reaches the least scores.
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
