#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "backend/geometry/se2.h"
#include "frontend/log/observation/observation.h"

namespace loopgrid {

/// The messages of a CARMEN log that are read. Lasers are listed in the order of preference: if a
/// log has several, the first one in this list is used.
enum class CarmenTag {
  kFlaser,
  kRobotLaser1,
  kRlaser,
  kRobotLaser2,
  kRawLaser1,
  kRawLaser2,
  kRawLaser3,
  kRawLaser4,
  kOdom,
  kParam,
  kOther,
};

/// What the line is, by its first word.
CarmenTag TagOf(std::string_view line);

inline bool IsLaser(CarmenTag tag) { return tag <= CarmenTag::kRawLaser4; }

/// The fields of a laser message.
struct CarmenLaserMessage {
  CarmenTag tag = CarmenTag::kOther;
  double timestamp = 0.0;  ///< ipc_timestamp, seconds

  bool has_poses = false;  ///< RAWLASER messages have none
  SE2 T_odom_laser;
  SE2 T_odom_robot;
  std::size_t laser_pose_begin = 0;  ///< offset of the laser's pose in the line, bytes
  std::size_t laser_pose_end = 0;

  bool has_angles = false;          ///< FLASER and RLASER messages have none
  double start_angle = 0.0;         ///< of ranges[0], radians
  double field_of_view = 0.0;       ///< radians, 0 where not given
  double angular_resolution = 0.0;  ///< radians, 0 where not given
  double max_range = 0.0;           ///< metres, 0 where not given
  std::vector<float> ranges;        ///< metres, finite and not negative
};

/// Reads a line of one of the laser tags. Returns what is wrong with it, or an empty string if
/// `message` is complete. Refuses readings that are NaN, infinite or negative, counts above
/// `kMaxReadings`, and implausible poses.
std::string ParseLaserLine(std::string_view line, CarmenLaserMessage* message);

/// Reads an ODOM line's pose; returns what is wrong with it, or an empty string.
std::string ParseOdometryLine(std::string_view line, SE2* T_odom_robot);

}  // namespace loopgrid
