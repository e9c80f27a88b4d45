#pragma once

#include <Eigen/Core>
#include <vector>

#include "frontend/closing/closing_options.h"
#include "frontend/closing/nodes.h"
#include "frontend/matching/correlative_matcher.h"

namespace loopgrid {

/// Where an old place may be seen again.
struct ClosureCandidate {
  int node = 0;                  ///< the likeliest node of the pass
  double distance = 0.0;         ///< of the current pose from it, metres
  double distance_sigmas = 0.0;  ///< the part of `distance` beyond the view distance, in sigmas
  SearchWindow window;           ///< in the frame of `node`
};

/// The old nodes, from `first_node` on, that may be within view of the newest node by their
/// marginal covariance (Section V-A of the tutorial: the 3 sigma region contains the current pose).
/// When the robot passed a place several times, each pass contributes its likeliest node only. The
/// likeliest pass comes first. `covariances[j]` is the covariance of node j relative to the newest,
/// in j's own frame.
std::vector<ClosureCandidate> FindCandidates(const Nodes& nodes, int first_node,
                                             const std::vector<Eigen::Matrix3d>& covariances,
                                             const ClosureGateOptions& options);

}  // namespace loopgrid
