#pragma once

#include <vector>

#include "backend/geometry/se2.h"

namespace loopgrid {

/// The most readings a scan may have.
inline constexpr int kMaxReadings = 1 << 14;

/// Readers of logs replace longer readings by this one, metres. No planar laser sees so far, so
/// such readings can only mean "no return". The limit keeps all numbers computed from readings
/// finite.
inline constexpr float kFarthestReading = 1e4F;

/// One sweep of a planar laser as the log has it. There is at least one range. All ranges are
/// finite and not negative. Some of them may stand for "no return"; NoReturnRule finds out which.
struct LaserScan {
  SE2 T_robot_laser;          ///< where the laser sits on the robot
  double first_angle = 0.0;   ///< of ranges[0] in the laser frame, radians
  double angle_step = 0.0;    ///< radians between two beams, may be negative
  double max_range = 0.0;     ///< as the log states it, metres; 0 where the log does not
  std::vector<float> ranges;  ///< metres
};

/// What a log consists of: a scan with the odometry at its time.
struct Observation {
  double timestamp = 0.0;  ///< seconds, as in the log; may run backwards
  SE2 T_odom_robot;        ///< wheel odometry at the scan
  LaserScan scan;
  bool new_session = false;  ///< the robot may have been carried: it can be anywhere in the map
};

}  // namespace loopgrid
