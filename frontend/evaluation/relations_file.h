#pragma once

#include <string>
#include <vector>

#include "backend/geometry/se2.h"

namespace loopgrid {

/// The true relative pose of two moments of a recording.
struct Relation {
  double t1 = 0.0;  ///< seconds
  double t2 = 0.0;  ///< seconds; may be before t1
  SE2 T_1_2;        ///< pose at t2 seen from the pose at t1
};

/// Reads relations as published with Kuemmerle et al., "On measuring the accuracy of SLAM
/// algorithms", 2009: `t1 t2 x y z roll pitch yaw` a line, metres and radians, `#` beginning a
/// comment. Strict: throws Error (kInput) `file:line: ...` for any other line, and for a file
/// without a relation.
std::vector<Relation> ReadRelationsFile(const std::string& path);

}  // namespace loopgrid
