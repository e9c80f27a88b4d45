#pragma once

#include "frontend/matching/matching_options.h"

namespace loopgrid {

/// Noise of wheel odometry: standard deviations of one motion.
struct OdometryNoise {
  double translation_per_metre = 0.15;   ///< metres for a metre travelled
  double translation_per_radian = 0.05;  ///< metres for a radian turned
  double rotation_per_metre = 0.06;      ///< radians for a metre travelled
  double rotation_per_radian = 0.15;     ///< radians for a radian turned
  double translation_floor = 0.01;       ///< metres, of any motion
  double rotation_floor = 0.01;          ///< radians, of any motion

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

struct TrackerOptions {
  OdometryNoise odometry{};
  RefinerOptions refiner{};
  MatchCovarianceOptions covariance{};
  double table_resolution = 0.05;     ///< of the likelihood table, metres
  double table_sigma = 0.07;          ///< of the likelihood around a surface, metres
  double map_radius = 30.0;           ///< surfaces farther from the robot are left out, metres
  double window_sigmas = 3.0;         ///< half width of the search, in sigmas of the odometry
  double window_margin = 0.05;        ///< searched beyond that, metres
  double window_angle_margin = 0.02;  ///< searched beyond that, radians
  double widest_rotation = 0.6;       ///< searched on either side at most, radians
  double prior_weight = 0.02;  ///< see SearchPrior: an offset of 3 sigma costs 0.09 of the score
  double min_score = 0.35;     ///< of the correlative search, 0..1
  double min_inlier_share = 0.25;  ///< of the refined match, 0..1
  int min_points = 20;             ///< scans with fewer hits are not matched

  // If the match near the odometry's prediction fails, a wider search in all directions follows.
  double lost_reach = 1.0;              ///< half width of that search, metres
  double lost_min_score = 0.5;          ///< as min_score
  double lost_min_inlier_share = 0.65;  ///< as min_inlier_share
  double lost_max_second = 0.8;     ///< a second place with this share of the score is a failure
  double lost_peak_distance = 0.5;  ///< another place is at least this far away, metres ...
  double lost_peak_angle = 0.3;     ///< ... or turned by this much, radians

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

/// Which space is known. The robot adds no new nodes there.
struct KnownSpaceOptions {
  double distance = 1.0;           ///< nodes this near make a place known, metres
  int passes = 3;                  ///< ... if they are of so many passes, or of an earlier session
  int same_pass = 10;              ///< nodes this many apart or fewer are of one pass
  int recent_nodes = 20;           ///< the newest nodes do not count: the robot is still there
  double recent_path = 10.0;       ///< nor do nodes less than this much travel ago, metres
  int closed_within = 10;          ///< one of this many newest nodes must have closed a loop
  int map_nodes = 30;              ///< the nearest nodes that scans are matched with
  double min_inlier_share = 0.75;  ///< of a scan's hits that these nodes must explain, 0..1
  double max_shift = 0.15;  ///< between the robot's pose by the graph and by these nodes, metres
  double max_turn = 0.05;   ///< the same in radians

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

}  // namespace loopgrid
