#pragma once

#include <vector>

#include "backend/geometry/se2.h"

namespace loopgrid {

/// One sweep of a planar laser as the log has it. Ranges are finite and not negative; the readings
/// that stand for "no return" are still in there (SensorModel tells them from walls).
struct LaserScan {
  SE2 T_robot_laser;          ///< where the laser sits on the robot
  double first_angle = 0.0;   ///< of ranges[0] in the laser frame, radians
  double angle_step = 0.0;    ///< radians between two beams, may be negative
  double max_range = 0.0;     ///< as the log states it, metres; 0 where the log does not
  std::vector<float> ranges;  ///< metres
};

/// What a log yields: a scan with the odometry of its moment.
struct Observation {
  double timestamp = 0.0;  ///< seconds, as in the log; may run backwards
  SE2 T_odom_robot;        ///< wheel odometry at the scan
  LaserScan scan;
};

}  // namespace loopgrid
