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
  std::size_t outside = 0;              ///< a time lies outside the trajectory; not judged
  std::vector<RelationError> errors;    ///< of all that are judged, in the relations' order
};

/// The metric of Kuemmerle et al., "On measuring the accuracy of SLAM algorithms", 2009: the
/// component-wise difference of estimated and given relative pose, its translation's norm in metres
/// and its angle's size in degrees. Nothing is aligned.
RelationEvaluation EvaluateRelations(const Trajectory& trajectory,
                                     std::span<const Relation> relations);

}  // namespace loopgrid
