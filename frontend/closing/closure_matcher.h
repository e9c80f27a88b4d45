#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "frontend/matching/correlative_matcher.h"
#include "frontend/matching/local_map.h"
#include "frontend/matching/match_refiner.h"

namespace loopgrid {

struct ClosureMatcherOptions {
  RefinerOptions refiner;
  double fine_resolution = 0.05;    ///< of the likelihood table for small windows, metres
  double coarse_resolution = 0.10;  ///< ... for large ones, metres
  double fine_sigma = 0.07;         ///< reach of a reference point in the table, metres
  double coarse_sigma = 0.10;       ///< ... for large windows, metres
  double coarse_from = 1.0;         ///< windows from this half width on are large, metres
  std::size_t coarse_points = 300;  ///< searched with in large windows at most
  double widest = 25.0;             ///< half width that is searched at most, metres
  double min_score = 0.5;           ///< of the correlative search, 0..1
  double min_inlier_share = 0.5;    ///< of the refined match, 0..1
  double peak_distance = 0.8;       ///< a second peak is at least this far away, metres ...
  double peak_angle = 0.35;         ///< ... or turned by this much, radians
};

/// Outcome of matching a node's scan with the map around an old node.
struct ClosureMatch {
  bool found = false;  ///< a pose reached the scores
  SE2 T_map_robot;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< robot frame, order (x, y, theta)
  double score = 0.0;                                    ///< best of the search, 0..1
  double second_score = 0.0;                             ///< best away from it, 0..1
  double inlier_share = 0.0;                             ///< see RefinedMatch
  double denied_share = 0.0;                             ///< see Visibility
};

/// Finds `scan` in `map` within `window` around `predicted`. `surroundings` are the points to
/// search with, robot frame: the scan's own hits, or those of the last few nodes together where one
/// scan would look like many places.
ClosureMatch MatchClosure(const LocalMap& map, const PointScan& scan,
                          std::span<const Eigen::Vector2f> surroundings, const SE2& predicted,
                          const SearchWindow& window, const ClosureMatcherOptions& options);

}  // namespace loopgrid
