#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "frontend/closing/closing_options.h"
#include "frontend/closing/closure.h"
#include "frontend/closing/closure_gate.h"
#include "frontend/closing/closure_matcher.h"
#include "frontend/closing/nodes.h"
#include "frontend/closing/place_finder.h"
#include "frontend/closing/session.h"

namespace loopgrid {

/// Proposes closures: matches the scan of the newest node with the maps around old nodes.
class ClosureFinder {
 public:
  explicit ClosureFinder(const ClosureFinderOptions& options = {}) : options_(options) {}

  /// Matches the newest node, whose scan was taken at `timestamp`, with the old places inside the
  /// gate. While the session is not localized, also matches it with all places of the older map.
  /// `covariances[j]` is the covariance of node j relative to the newest, in j's own frame. Returns
  /// every attempt. Attempts that may be accepted have the outcome kPending.
  std::vector<Closure> Propose(const Nodes& nodes, const Session& session, double timestamp,
                               const std::vector<Eigen::Matrix3d>& covariances);

 private:
  Closure Match(const Nodes& nodes, const ClosureCandidate& candidate) const;
  std::optional<Closure> FindAnywhere(const Nodes& nodes, const Session& session);
  ClosureOutcome Judge(const ClosureMatch& match) const;
  Closure MakeClosure(const ClosureMatch& match, int from, int to) const;
  std::vector<Eigen::Vector2f> Surroundings(const Nodes& nodes) const;

  ClosureFinderOptions options_;
  std::optional<PlaceFinder> place_finder_;  // while the session is not localized
  int place_finder_nodes_ = 0;               // number of nodes in its map
};

}  // namespace loopgrid
