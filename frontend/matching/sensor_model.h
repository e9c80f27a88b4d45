#pragma once

#include <vector>

#include "frontend/matching/matching_options.h"
#include "frontend/matching/point_scan.h"

namespace loopgrid {

/// Learns from the scans seen so far from which range on a reading means "no return", so that the
/// user need not state it. Causal: how a scan is interpreted depends on it and earlier ones only.
class SensorModel {
 public:
  explicit SensorModel(const SensorModelOptions& options = {})
      : options_(options), usable_range_(options.max_range) {}

  /// Takes the readings of `scan` into account, then makes points of it.
  PointScan Interpret(const LaserScan& scan);

  /// Readings at or above this are "no return", metres.
  double usable_range() const { return usable_range_; }

 private:
  void Learn(const LaserScan& scan);

  SensorModelOptions options_;
  std::vector<int> histogram_;  ///< readings in each bin
  double usable_range_;
};

}  // namespace loopgrid
