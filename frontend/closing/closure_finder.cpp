#include "frontend/closing/closure_finder.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace loopgrid {
namespace {

// Standard deviation of the position in its least certain direction, metres.
double LargestSigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance.topLeftCorner<2, 2>());
  return std::sqrt(solver.eigenvalues()(1));
}

}  // namespace

std::vector<Closure> ClosureFinder::Propose(const Nodes& nodes, const Session& session,
                                            double timestamp,
                                            const std::vector<Eigen::Matrix3d>& covariances) {
  const int first_node = session.localized ? 0 : session.first_node;
  std::vector<Closure> closures;
  for (const ClosureCandidate& candidate :
       FindCandidates(nodes, first_node, covariances, options_.gate)) {
    closures.push_back(Match(nodes, candidate));
  }
  if (session.localized) {
    place_finder_.reset();
  } else if (std::optional<Closure> closure = FindAnywhere(nodes, session)) {
    closures.push_back(*closure);
  }
  for (Closure& closure : closures) closure.timestamp = timestamp;
  return closures;
}

Closure ClosureFinder::Match(const Nodes& nodes, const ClosureCandidate& candidate) const {
  const int newest = nodes.size() - 1;
  const int j = candidate.node;
  NodeRange range = nodes.Around(j, options_.map_path);
  range.last = std::min(range.last, std::max(j, newest - options_.gate.recent_nodes));
  const LocalMap map = nodes.MapOf(range, j, options_.map_radius);
  const PointScan& scan = nodes.scan(newest);
  const bool wide = std::max(candidate.window.x, candidate.window.y) >= options_.surroundings_from;
  const std::vector<Eigen::Vector2f> points = wide ? Surroundings(nodes) : scan.hits;
  const ClosureMatch match =
      MatchClosure(map, scan, points, nodes.Between(j, newest), candidate.window, options_.matcher);
  Closure closure = MakeClosure(match, j, newest);
  closure.distance_sigmas = candidate.distance_sigmas;
  return closure;
}

std::optional<Closure> ClosureFinder::FindAnywhere(const Nodes& nodes, const Session& session) {
  const int newest = nodes.size() - 1;
  if (!place_finder_ || place_finder_nodes_ != session.first_node) {
    place_finder_.emplace(nodes, session.first_node, options_.place_finder);
    place_finder_nodes_ = session.first_node;
  }
  const int age = newest - session.first_node;
  const int steps = age > options_.eager_nodes
                        ? options_.max_node_steps
                        : std::clamp(place_finder_->places() / options_.places_a_node, 1,
                                     options_.max_node_steps);
  if (age % steps != 0) return std::nullopt;
  const std::optional<FoundPlace> found =
      place_finder_->Find(nodes.scan(newest), Surroundings(nodes), options_.matcher);
  if (!found) return std::nullopt;
  return MakeClosure(found->match, found->node, newest);
}

// The surfaces seen from the last few nodes, in the frame of the newest.
std::vector<Eigen::Vector2f> ClosureFinder::Surroundings(const Nodes& nodes) const {
  const int newest = nodes.size() - 1;
  const NodeRange range = nodes.Around(newest, options_.surroundings_path);
  const LocalMap map = nodes.MapOf(range, newest, options_.map_radius);
  std::vector<Eigen::Vector2f> points;
  points.reserve(map.surfels().size());
  for (const Surfel& s : map.surfels()) points.push_back(s.position);
  return points;
}

ClosureOutcome ClosureFinder::Judge(const ClosureMatch& match) const {
  if (!match.found) return ClosureOutcome::kLowScore;
  if (match.second_score > options_.max_second_share * match.score) {
    return ClosureOutcome::kAmbiguous;
  }
  if (match.denied_share > options_.max_denied_share) return ClosureOutcome::kContradicted;
  if (LargestSigma(match.covariance) > options_.max_sigma) return ClosureOutcome::kUnconstrained;
  return ClosureOutcome::kPending;
}

Closure ClosureFinder::MakeClosure(const ClosureMatch& match, int from, int to) const {
  Closure closure;
  closure.from = from;
  closure.to = to;
  closure.score = match.score;
  closure.second_score = match.second_score;
  closure.inlier_share = match.inlier_share;
  closure.denied_share = match.denied_share;
  closure.T_from_to = match.T_map_robot;
  closure.covariance = match.covariance;
  closure.outcome = Judge(match);
  return closure;
}

}  // namespace loopgrid
