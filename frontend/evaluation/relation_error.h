#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "frontend/evaluation/error_summary.h"
#include "frontend/evaluation/relations_file.h"
#include "frontend/evaluation/tum_file.h"

namespace loopgrid {

/// The error of one relation.
struct RelationError {
  std::size_t relation = 0;  ///< its index
  bool exact = false;        ///< the trajectory has a pose at both of its times
  double translation = 0.0;  ///< metres
  double rotation = 0.0;     ///< degrees
};

struct RelationErrorSummaries {
  ErrorSummary translation;  ///< metres
  ErrorSummary rotation;     ///< degrees
};

struct RelationEvaluation {
  RelationErrorSummaries exact;         ///< both times have a pose within 0.1 ms
  RelationErrorSummaries interpolated;  ///< at least one time lies between two poses
  std::size_t outside = 0;  ///< relations with a time outside the trajectory; not evaluated
  std::vector<RelationError> errors;  ///< of all relations evaluated, in their order
};

/// The metric of Kuemmerle et al., "On measuring the accuracy of SLAM algorithms", 2009: the
/// difference of estimated and given relative pose, component by component. The errors are the norm
/// of its translation (metres) and the size of its angle (degrees). The trajectory is not aligned.
RelationEvaluation EvaluateRelations(const Trajectory& trajectory,
                                     std::span<const Relation> relations);

}  // namespace loopgrid
