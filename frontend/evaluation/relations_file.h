#pragma once

#include <string>
#include <vector>

#include "backend/geometry/se2.h"
#include "frontend/evaluation/number_table.h"

namespace loopgrid {

/// The true relative pose of two moments of a recording.
struct Relation {
  double t1 = 0.0;  ///< seconds
  double t2 = 0.0;  ///< seconds; may be before t1
  SE2 T_1_2;        ///< pose at t2 seen from the pose at t1
};

/// Relations as published with Kuemmerle et al., "On measuring the accuracy of SLAM algorithms",
/// 2009: `t1 t2 x y z roll pitch yaw` a line, metres and radians; z, roll and pitch are not used.
/// Throws Error (kInput) `file:line: ...` for a line with an impossible pose, and for a table
/// without lines.
std::vector<Relation> RelationsFrom(const NumberTable& table);

/// Reads such a file. Throws Error (kInput) as ReadNumberTable and RelationsFrom do.
std::vector<Relation> ReadRelationsFile(const std::string& path);

}  // namespace loopgrid
