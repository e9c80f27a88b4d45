#pragma once

#include <Eigen/Core>

#include "backend/geometry/se2.h"

namespace loopgrid {

/// Identifies a closure: its place in the list of all closures tried, from 0. The graph keeps it
/// beside the closure's constraint.
using ClosureId = int;
inline constexpr ClosureId kNoClosure = -1;  ///< of constraints that are no closures

/// What became of an attempt to close a loop.
enum class ClosureOutcome {
  kPending,        ///< matched; it waits for other closures that agree with it
  kAccepted,       ///< in the graph
  kLowScore,       ///< the scans do not fit well enough
  kAmbiguous,      ///< a second place fits nearly as well
  kContradicted,   ///< beams would have gone through walls
  kUnconstrained,  ///< the match does not fix the place, as in a corridor without features
  kInconsistent,   ///< no other closures agree with it
  kRejected,       ///< taken out again: chi2 too large after optimisation
};

/// The name written to closures.csv: "accepted", "low-score", ...
const char* ToString(ClosureOutcome outcome);

/// The reason in plain words, for the live page.
const char* Explain(ClosureOutcome outcome);

/// One attempt to close a loop: the scan of a new node, matched with the map around an old node.
struct Closure {
  ClosureId id = kNoClosure;
  int from = 0;            ///< the old node
  int to = 0;              ///< the newer node, the one whose scan was matched
  double timestamp = 0.0;  ///< of the newer node's scan, seconds
  double distance_sigmas =
      0.0;             ///< of the old node from the pose before the match, see ClosureCandidate
  double score = 0.0;  ///< match score, 0..1; 0 if no place came near the least score
  double second_score = 0.0;  ///< best score of a separate peak, 0..1; 0 if none came near
  double inlier_share = 0.0;  ///< of the scan's hits, those near a surface, 0..1
  double denied_share = 0.0;  ///< of the walls in view, those that beams would have gone through
  SE2 T_from_to;              ///< measured pose of `to` in `from`
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of T_from_to, order (x, y, theta)
  double chi2 = 0.0;  ///< of the constraint after optimisation; 0 if it was never in the graph
  ClosureOutcome outcome = ClosureOutcome::kPending;
};

}  // namespace loopgrid
