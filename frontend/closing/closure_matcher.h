#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "frontend/closing/closing_options.h"
#include "frontend/matching/correlative_matcher.h"
#include "frontend/matching/local_map.h"
#include "frontend/matching/match_refiner.h"

namespace loopgrid {

/// Outcome of matching a node's scan with the map around an old node.
struct ClosureMatch {
  bool found = false;  ///< a pose reached the least scores
  SE2 T_map_robot;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< robot frame, order (x, y, theta)
  double score = 0.0;                                    ///< best of the search, 0..1
  double second_score = 0.0;                             ///< best score of another place, 0..1
  double inlier_share = 0.0;                             ///< see RefinedMatch
  double denied_share = 0.0;                             ///< see Visibility
};

/// Finds `scan` in `map` within `window` around `predicted`. `surroundings` are the points that the
/// search uses, robot frame: the scan's own hits, or the hits of the last few nodes together if one
/// scan alone would fit at many places.
ClosureMatch MatchClosure(const LocalMap& map, const PointScan& scan,
                          std::span<const Eigen::Vector2f> surroundings, const SE2& predicted,
                          const SearchWindow& window, const ClosureMatcherOptions& options);

}  // namespace loopgrid
