#pragma once

#include <Eigen/Core>

#include "backend/geometry/se2.h"

namespace loopgrid {

/// What became of an attempt to close a loop.
enum class ClosureOutcome {
  kPending,        ///< matched, waiting for others to agree with it
  kAccepted,       ///< in the graph
  kLowScore,       ///< the scans do not fit well enough
  kAmbiguous,      ///< a second place fits nearly as well
  kContradicted,   ///< beams would have gone through walls
  kUnconstrained,  ///< the fit leaves the place open, as in a bare corridor
  kInconsistent,   ///< no others agree with it
  kRejected,       ///< taken out again: chi-square too large after optimisation
};

/// The name written to closures.csv: "accepted", "low-score", ...
const char* ToString(ClosureOutcome outcome);

/// The reason in plain words, for whoever watches.
const char* Explain(ClosureOutcome outcome);

/// One closure tried: the audit trail.
struct ClosureRecord {
  int from = 0;            ///< the old node
  int to = 0;              ///< the newer node, the one whose scan was matched
  double timestamp = 0.0;  ///< of the newer node's scan
  double distance_sigmas =
      0.0;                    ///< of the old node from the pose before the match, see gate_sigmas
  double score = 0.0;         ///< match score, 0..1; 0 where none came near the least one
  double second_score = 0.0;  ///< best score of a separate peak, 0..1; 0 where none is near
  double inlier_share = 0.0;  ///< of the scan's hits, those near a surface, 0..1
  double denied_share = 0.0;  ///< of the walls in view, those that beams would have gone through
  SE2 T_from_to;              ///< measured pose of `to` in `from`
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of T_from_to, order (x, y, theta)
  double chi2 = 0.0;  ///< of the constraint after optimisation, where it got that far
  ClosureOutcome outcome = ClosureOutcome::kPending;
};

}  // namespace loopgrid
