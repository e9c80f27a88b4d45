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
  double distance_sigmas = 0.0;  ///< of the part of it beyond the view distance, in sigmas
  SearchWindow window;           ///< in the frame of `node`
};

/// The old nodes, from `first_node` on, whose marginal covariance lets the newest node be within
/// view of them (Section V-A of the tutorial: its 3 sigma region contains the current pose). Of
/// each pass by the place only the likeliest node, the most likely pass first. `covariances[j]` is
/// that of node j relative to the newest, in j's own frame.
std::vector<ClosureCandidate> FindCandidates(const Nodes& nodes, int first_node,
                                             const std::vector<Eigen::Matrix3d>& covariances,
                                             const ClosureGateOptions& options);

}  // namespace loopgrid
