#pragma once

#include "backend/geometry/se2.h"
#include "frontend/slam/slam_options.h"

namespace loopgrid {

/// Counts scans taken on one spot, because a robot may be parked for hours.
class Standstill {
 public:
  explicit Standstill(const StandstillOptions& options) : options_(options) {}

  /// Takes the pose of the next scan. True if the map has enough scans from this spot.
  bool HasEnough(const SE2& T_map_robot);

 private:
  StandstillOptions options_;
  SE2 spot_;  // pose after the last motion of the robot
  int scans_ = 0;
};

}  // namespace loopgrid
