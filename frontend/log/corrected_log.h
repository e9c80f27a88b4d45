#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "backend/geometry/se2.h"

namespace loopgrid {

/// Where a scan was taken after all, and where its laser sits.
struct CorrectedScan {
  SE2 T_map_robot;
  SE2 T_robot_laser;
};

struct CorrectedLogStatistics {
  std::int64_t lines = 0;     ///< written
  std::int64_t left_out = 0;  ///< malformed lines of the input
};

/// Writes a log again with the corrected pose of each scan that OpenLog() gives out of it, in the
/// same order, as a CARMEN log, whole or not at all.
/// From a CARMEN log every line goes through as it is but for the laser's pose in the laser
/// messages, which becomes the corrected one; the robot's pose stays raw odometry. Scans of lasers
/// not in use take the correction of the scan before them. RAWLASER messages of the laser in use,
/// which have no place for a pose, become ROBOTLASER messages. A mount that PARAM lines do not
/// state is stated before the first scan. Malformed lines are left out. From a rawlog, ROBOTLASER1
/// messages are made of its scans.
/// Throws Error (kInput) if the input cannot be read or has not `scans.size()` scans, Error
/// (kOutput) if the output cannot be written.
CorrectedLogStatistics WriteCorrectedLog(const std::string& input, const std::string& output,
                                         std::span<const CorrectedScan> scans);

}  // namespace loopgrid
