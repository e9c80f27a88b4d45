#pragma once

#include <string>

#include "tests/support/simulator.h"

namespace loopgrid::test_support {

/// The message that has the scans in a CARMEN log.
enum class CarmenDialect {
  kFlaser,       ///< old: poses of laser and robot, no angles
  kRobotLaser1,  ///< new: also angles, maximum range and more
};

/// The run as the text of a CARMEN log: PARAM lines, then an ODOM line and the scan of each
/// observation.
std::string CarmenText(const SimulatedRun& run, CarmenDialect dialect);

/// The true poses as the text of a trajectory in the format of the TUM RGB-D benchmark.
std::string TrueTrajectoryText(const SimulatedRun& run);

}  // namespace loopgrid::test_support
