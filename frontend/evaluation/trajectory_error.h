#pragma once

#include <cstddef>

#include "backend/geometry/se2.h"
#include "frontend/evaluation/error_summary.h"
#include "frontend/evaluation/tum_file.h"

namespace loopgrid {

struct TrajectoryEvaluation {
  ErrorSummary translation;   ///< metres, after alignment; `count` poses could be compared
  ErrorSummary rotation;      ///< degrees, after alignment
  std::size_t unmatched = 0;  ///< reference poses without an estimate near enough in time
  SE2 T_reference_estimate;   ///< the alignment
};

/// The absolute trajectory error: each pose of the reference is compared with the estimate's
/// nearest in time, if within `tolerance` seconds, after the rigid motion (no scale) that brings
/// the positions together best in the least-squares sense (Umeyama 1991, in the plane).
TrajectoryEvaluation EvaluateTrajectory(const Trajectory& estimate, const Trajectory& reference,
                                        double tolerance = 0.02);

}  // namespace loopgrid
