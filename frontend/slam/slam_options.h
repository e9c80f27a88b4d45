#pragma once

#include "frontend/closing/closing_options.h"
#include "frontend/matching/matching_options.h"
#include "frontend/tracking/tracking_options.h"

namespace loopgrid {

/// While the robot stands still, all scans are the same. Only a few of them are added to the map.
struct StandstillOptions {
  double distance = 0.05;  ///< scans at most this far apart are from one spot, metres
  double angle = 0.05;     ///< and turned by at most this much, radians
  int max_scans = 10;      ///< scans on one spot that are kept for the map

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

/// A motion between two scans that is too long for a robot: it was carried, or its odometry was
/// reset.
struct CarriedOptions {
  double distance = 10.0;    ///< longer motions are taken for this, metres
  double farthest = 1000.0;  ///< a longer one is not used to predict the place, metres

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

/// All options of the algorithm. One set of defaults for all logs; what depends on the sensor is
/// derived from the log.
struct SlamOptions {
  static constexpr double kLeastNodeDistance = 0.05;  ///< metres
  static constexpr double kMostNodeDistance = 10.0;   ///< metres
  static constexpr double kLeastNodeAngle = 0.05;     ///< radians
  static constexpr double kMostNodeAngle = 3.0;       ///< radians

  double node_distance = 0.5;     ///< a new node after this much travel, metres
  double node_angle = 0.5;        ///< ... or after this much turning, radians
  int tracked_nodes = 20;         ///< number of newest nodes with whose scans tracking matches
  double unmatched_factor = 4.0;  ///< of the odometry's covariance where a match failed
  int update_lag = 5;  ///< the changes that a node causes are applied this many steps later
  int threads = 2;     ///< 1: loops are closed in the calling thread; the result is the same

  NoReturnOptions no_return{};
  TrackerOptions tracker{};
  KnownSpaceOptions known_space{};
  ClosingOptions closing{};
  StandstillOptions standstill{};
  CarriedOptions carried{};

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

}  // namespace loopgrid
