#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "frontend/evaluation/relations_file.h"
#include "frontend/evaluation/tum_file.h"

namespace loopgrid {

/// What a trajectory can be compared with.
enum class ReferenceKind {
  kTrajectory,  ///< another trajectory, in TUM format
  kRelations,   ///< true relative poses
};

using Reference = std::variant<Trajectory, std::vector<Relation>>;

/// Guesses of which kind a file is; both kinds have eight numbers a line. A file is a trajectory if
/// more than half of its lines can be poses with a time: columns 2 and 3 are a position within
/// bounds, and the last four a quaternion whose norm is 0.9 to 1.1. A relation in the plane also
/// ends in `0 0 0 w`. For such lines w has to be 1 or -1 to within 0.01.
ReferenceKind GuessReferenceKind(const NumberTable& table);

/// Reads a reference as `kind`, or as GuessReferenceKind says if there is none. The file is read
/// once, so that it may be a pipe.
/// Throws Error (kInput) as the readers of trajectories and relations do.
Reference ReadReference(const std::string& path, std::optional<ReferenceKind> kind);

}  // namespace loopgrid
