#pragma once

#include <vector>

#include "frontend/matching/matching_options.h"
#include "frontend/matching/point_scan.h"

namespace loopgrid {

/// Finds out, from the scans so far, from which range on a reading means "no return". So the user
/// need not state it. How a scan is interpreted depends only on it and on earlier scans.
class NoReturnRule {
 public:
  explicit NoReturnRule(const NoReturnOptions& options = {})
      : options_(options), usable_range_(options.max_range) {}

  /// Adds the readings of `scan` to the histogram, then makes points of the scan.
  PointScan Interpret(const LaserScan& scan);

  /// Readings at or above this are "no return", metres.
  double usable_range() const { return usable_range_; }

 private:
  void Learn(const LaserScan& scan);

  NoReturnOptions options_;
  std::vector<int> histogram_;  ///< readings in each bin
  double usable_range_;
};

}  // namespace loopgrid
