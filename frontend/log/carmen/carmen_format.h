#pragma once

#include <string>

#include "backend/geometry/se2.h"
#include "frontend/log/carmen/carmen_line.h"
#include "frontend/log/observation/observation.h"

namespace loopgrid {

/// The text of a pose in CARMEN's messages: `x y theta`, to micrometres and microradians.
std::string CarmenPose(const SE2& pose);

/// The PARAM lines that state the mount of the front or the rear laser on the robot.
std::string CarmenMountLines(bool front, const SE2& T_robot_laser);

/// A whole ROBOTLASER1 or ROBOTLASER2 line with its line end: the scan with the laser's pose as
/// given and the robot's as in the odometry, without remissions, `log_time` seconds into the log.
/// CARMEN's beams go counter-clockwise. The order of beams that go clockwise is reversed.
std::string CarmenRobotLaserLine(bool front, const Observation& observation, const SE2& T_map_laser,
                                 double log_time);

}  // namespace loopgrid
