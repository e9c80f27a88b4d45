#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "frontend/evaluation/tum_file.h"

namespace loopgrid {

/// Finds the poses of a trajectory by time. Their times may be in any order.
class TrajectoryLookup {
 public:
  explicit TrajectoryLookup(const Trajectory& trajectory);

  /// Index in the trajectory of the pose nearest in time, of several as near the first in file
  /// order; none if even that is more than `tolerance` seconds away.
  std::optional<std::size_t> Nearest(double timestamp, double tolerance) const;

  /// The pose between the two that bracket the time, translation and angle in proportion; none
  /// outside the time span.
  std::optional<SE2> Interpolate(double timestamp) const;

 private:
  struct Entry {
    double timestamp;
    std::size_t index;
  };
  using Iterator = std::vector<Entry>::const_iterator;

  Iterator FirstNotBefore(double timestamp) const;

  const Trajectory& trajectory_;
  std::vector<Entry> by_time_;  // equal times in file order
};

}  // namespace loopgrid
