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

  /// Index of the pose nearest in time; if several are equally near, the first in file order.
  /// Nothing if the nearest is more than `tolerance` seconds away.
  std::optional<std::size_t> Nearest(double timestamp, double tolerance) const;

  /// Interpolates linearly between the two poses around the time, translation and angle. Nothing
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
