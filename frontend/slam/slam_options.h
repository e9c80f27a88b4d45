#pragma once

namespace loopgrid {

/// One set of defaults for all logs; what depends on the sensor is derived from the log.
struct SlamOptions {
  double node_distance = 0.5;  ///< a new node after this much travel, metres
  double node_angle = 0.5;     ///< ... or after this much turning, radians
  int threads = 2;  ///< 1: loops are closed in the calling thread; the result is the same

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

}  // namespace loopgrid
