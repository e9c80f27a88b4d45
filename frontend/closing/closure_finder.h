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
  /// gate; while the session is not localized, with all places of the older map, too.
  /// `covariances[j]` is that of node j relative to the newest, in j's own frame. Returns every
  /// attempt; the outcome of those that look good is kPending.
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
  int place_finder_nodes_ = 0;               // how many nodes its map is made of
};

}  // namespace loopgrid
