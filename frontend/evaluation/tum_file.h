#pragma once

#include <string>
#include <vector>

#include "backend/geometry/se2.h"
#include "frontend/evaluation/number_table.h"

namespace loopgrid {

/// A pose with its time, seconds.
struct StampedPose {
  double timestamp = 0.0;
  SE2 pose;
};

/// A trajectory in file order; its times may run backwards and repeat, as those of logs do.
using Trajectory = std::vector<StampedPose>;

/// Whether the quaternion's norm is 0.9 to 1.1. Quaternions in files are rounded.
bool IsNearUnitQuaternion(double qx, double qy, double qz, double qw);

/// A trajectory in the format of the TUM RGB-D benchmark: `time x y z qx qy qz qw` a line, seconds
/// and metres. Quaternions are normalised if IsNearUnitQuaternion. Only the yaw of rotations is
/// kept. Throws Error (kInput) `file:line: ...` for a line that is not a pose, and for a table
/// without lines.
Trajectory TrajectoryFrom(const NumberTable& table);

/// Reads such a file. Throws Error (kInput) as ReadNumberTable and TrajectoryFrom do.
Trajectory ReadTumFile(const std::string& path);

/// A planar trajectory in that format.
std::string FormatTum(const Trajectory& trajectory);

/// Writes it to a file, whole or not at all. Throws Error (kOutput).
void WriteTumFile(const std::string& path, const Trajectory& trajectory);

}  // namespace loopgrid
