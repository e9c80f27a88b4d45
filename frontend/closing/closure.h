#pragma once

#include <Eigen/Core>

#include "backend/geometry/se2.h"

namespace loopgrid {

/// Names a closure: its place in the list of all closures tried, from 0. Goes with the closure's
/// constraint through the graph.
using ClosureId = int;
inline constexpr ClosureId kNoClosure = -1;  ///< of constraints that are no closures

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

/// One attempt to close a loop: the scan of a new node, matched with the map around an old node.
struct Closure {
  ClosureId id = kNoClosure;
  int from = 0;            ///< the old node
  int to = 0;              ///< the newer node, the one whose scan was matched
  double timestamp = 0.0;  ///< of the newer node's scan, seconds
  double distance_sigmas =
      0.0;             ///< of the old node from the pose before the match, see ClosureCandidate
  double score = 0.0;  ///< match score, 0..1; 0 where no place came near the least score
  double second_score = 0.0;  ///< best score of a separate peak, 0..1; 0 where none is near
  double inlier_share = 0.0;  ///< of the scan's hits, those near a surface, 0..1
  double denied_share = 0.0;  ///< of the walls in view, those that beams would have gone through
  SE2 T_from_to;              ///< measured pose of `to` in `from`
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of T_from_to, order (x, y, theta)
  double chi2 = 0.0;  ///< of the constraint after optimisation, where it got that far
  ClosureOutcome outcome = ClosureOutcome::kPending;
};

}  // namespace loopgrid
