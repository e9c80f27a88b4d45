#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "backend/geometry/se2.h"

namespace loopgrid {

/// The corrected pose of a scan, and where its laser sits.
struct CorrectedScan {
  SE2 T_map_robot;
  SE2 T_robot_laser;
};

struct CorrectedLogStatistics {
  std::int64_t lines = 0;     ///< written
  std::int64_t left_out = 0;  ///< malformed lines of the input
};

/// Writes a log again, as a CARMEN log, with a corrected pose for each scan that OpenLog() reads
/// from it, in the same order. The file is written completely or not at all. Lines of a CARMEN log
/// are copied. In laser messages the laser's pose is replaced by the corrected one; the robot's
/// pose stays raw odometry. Scans of lasers not in use get the correction of the scan before them.
/// RAWLASER messages of the laser in use, which have no field for a pose, become ROBOTLASER
/// messages. If no PARAM line gives the laser's mount, such lines are written before the first
/// scan. Malformed lines are left out. The scans of a rawlog become ROBOTLASER1 messages. Throws
/// Error (kInput) if the input cannot be read or does not have `scans.size()` scans, Error
/// (kOutput) if the output cannot be written.
CorrectedLogStatistics WriteCorrectedLog(const std::string& input, const std::string& output,
                                         std::span<const CorrectedScan> scans);

}  // namespace loopgrid
