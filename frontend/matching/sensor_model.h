#pragma once

#include <vector>

#include "frontend/matching/point_scan.h"

namespace loopgrid {

/// Learns from the scans seen so far where "no return" begins, so that nobody has to say. Causal:
/// what it says of a scan depends on that scan and earlier ones only.
class SensorModel {
 public:
  /// Takes the readings of `scan` into account, then makes points of it.
  PointScan Interpret(const LaserScan& scan);

  /// Readings at or above this are "no return", metres.
  double usable_range() const { return usable_range_; }

 private:
  void Learn(const LaserScan& scan);

  std::vector<int> histogram_;  ///< readings per kBinWidth metres
  double usable_range_ = 40.0;
};

}  // namespace loopgrid
