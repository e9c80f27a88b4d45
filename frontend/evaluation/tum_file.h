#pragma once

#include <string>
#include <vector>

#include "backend/geometry/se2.h"

namespace loopgrid {

/// A pose with its time, seconds.
struct StampedPose {
  double timestamp = 0.0;
  SE2 pose;
};

/// A trajectory in file order; its times may run backwards and repeat, as those of logs do.
using Trajectory = std::vector<StampedPose>;

/// Reads a trajectory in the format of the TUM RGB-D benchmark, `time x y z qx qy qz qw` a line,
/// seconds and metres, `#` beginning a comment; of rotations the yaw is kept. Strict: throws
/// Error (kInput) `file:line: ...` for any other line, and for a file without a pose.
Trajectory ReadTumFile(const std::string& path);

/// A planar trajectory in that format.
std::string FormatTum(const Trajectory& trajectory);

/// Writes it to a file, whole or not at all. Throws Error (kOutput).
void WriteTumFile(const std::string& path, const Trajectory& trajectory);

}  // namespace loopgrid
