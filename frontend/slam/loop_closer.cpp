#include "frontend/slam/loop_closer.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "frontend/slam/consistency.h"

namespace loopgrid {
namespace {

// A covariance of motions in the frame of b, as motions in the frame of a.
Eigen::Matrix3d Transported(const SE2& T_a_b, const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d A = T_a_b.Adjoint();
  return A * covariance * A.transpose();
}

// What may go wrong between two nodes that tracking joined.
Eigen::Matrix3d ChainCovariance(double path) {
  const double translation = 0.02 + 0.01 * path;
  const double rotation = 0.005 + 0.002 * path;
  return Eigen::Vector3d(translation * translation, translation * translation, rotation * rotation)
      .asDiagonal();
}

// Standard deviation of the position in its least certain direction, metres.
double LargestSigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance.topLeftCorner<2, 2>());
  return std::sqrt(solver.eigenvalues()(1));
}

// Distance of `offset` beyond `reach` metres, in sigmas of `covariance`.
double SigmasBeyond(const Eigen::Vector2d& offset, double reach,
                    const Eigen::Matrix2d& covariance) {
  const double length = offset.norm();
  if (length <= reach) return 0.0;
  const Eigen::Vector2d beyond = offset * ((length - reach) / length);
  return std::sqrt(beyond.dot(covariance.ldlt().solve(beyond)));
}

}  // namespace

std::vector<ClosureCandidate> LoopCloser::FindCandidates(
    const Nodes& nodes, const std::vector<Eigen::Matrix3d>& covariances) const {
  const int newest = nodes.size() - 1;
  const int last_old = std::min(newest - options_.recent_nodes,
                                nodes.Around(newest, options_.recent_path).first - 1);

  std::vector<ClosureCandidate> places;
  int last_hit = -1000;
  double best_length = 0.0;
  for (int j = 0; j <= last_old; ++j) {
    const SE2 T_j_newest = nodes.Between(j, newest);
    const Eigen::Vector2d p = T_j_newest.translation();
    // Moving j by e in its own frame moves p by -e_xy and turns it by -e_theta.
    Eigen::Matrix<double, 2, 3> J;
    J << -1.0, 0.0, p.y(), 0.0, -1.0, -p.x();
    Eigen::Matrix2d S = J * covariances[static_cast<std::size_t>(j)] * J.transpose();
    S.diagonal().array() += 1e-6;
    const double sigmas = SigmasBeyond(p, options_.view_distance, S);
    if (sigmas > options_.gate_sigmas) continue;
    ClosureCandidate candidate;
    candidate.node = j;
    candidate.distance_sigmas = sigmas;
    const double theta_sigma = std::sqrt(covariances[static_cast<std::size_t>(j)](2, 2));
    candidate.window = {options_.gate_sigmas * std::sqrt(S(0, 0)) + 0.15,
                        options_.gate_sigmas * std::sqrt(S(1, 1)) + 0.15,
                        options_.gate_sigmas * theta_sigma + 0.05};
    // One place a pass: of consecutive nodes the likeliest, of those the nearest.
    const bool same_place = j - last_hit <= 5;
    const bool better =
        same_place && (sigmas < places.back().distance_sigmas ||
                       (sigmas <= places.back().distance_sigmas && p.norm() < best_length));
    if (!same_place) {
      places.push_back(candidate);
      best_length = p.norm();
    } else if (better) {
      places.back() = candidate;
      best_length = p.norm();
    }
    last_hit = j;
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const ClosureCandidate& a, const ClosureCandidate& b) {
                     return a.distance_sigmas < b.distance_sigmas;
                   });
  if (static_cast<int>(places.size()) > options_.max_candidates) {
    places.resize(static_cast<std::size_t>(options_.max_candidates));
  }
  return places;
}

std::vector<Eigen::Vector2f> LoopCloser::Surroundings(const Nodes& nodes, double path) const {
  const int newest = nodes.size() - 1;
  const LocalMap map = nodes.MapOf(nodes.Around(newest, path), newest, options_.map_radius);
  std::vector<Eigen::Vector2f> points;
  points.reserve(map.surfels().size());
  for (const Surfel& s : map.surfels()) points.push_back(s.position);
  return points;
}

void LoopCloser::Try(const Nodes& nodes, const ClosureCandidate& candidate) {
  const int newest = nodes.size() - 1;
  const int j = candidate.node;
  NodeRange range = nodes.Around(j, options_.map_path);
  range.last = std::min(range.last, std::max(j, newest - options_.recent_nodes));
  const LocalMap map = nodes.MapOf(range, j, options_.map_radius);
  const PointScan& scan = nodes.scan(newest);
  const bool wide = std::max(candidate.window.x, candidate.window.y) >= options_.surroundings_from;
  const std::vector<Eigen::Vector2f> points =
      wide ? Surroundings(nodes, options_.surroundings_path) : scan.hits;
  const ClosureMatch match =
      MatchClosure(map, scan, points, nodes.Between(j, newest), candidate.window, options_.matcher);
  ClosureRecord record;
  record.from = j;
  record.to = newest;
  record.distance_sigmas = candidate.distance_sigmas;
  record.score = match.score;
  record.second_score = match.second_score;
  record.T_from_to = match.T_map_robot;
  record.covariance = match.covariance;
  record.denied_share = match.denied_share;
  if (!match.found) {
    record.outcome = ClosureOutcome::kLowScore;
  } else if (match.second_score > options_.max_second_share * match.score) {
    record.outcome = ClosureOutcome::kAmbiguous;
  } else if (match.denied_share > options_.max_denied_share) {
    record.outcome = ClosureOutcome::kContradicted;
  } else if (LargestSigma(match.covariance) > options_.max_sigma) {
    record.outcome = ClosureOutcome::kUnconstrained;
  } else {
    record.outcome = ClosureOutcome::kPending;
    pool_.push_back(static_cast<int>(records_.size()));
  }
  records_.push_back(record);
}

double LoopCloser::Agreement(const Nodes& nodes, const ClosureRecord& a,
                             const ClosureRecord& b) const {
  // Round the loop: old a -> new a -> new b against old a -> old b -> new b.
  const SE2 old_step = nodes.Between(a.from, b.from);
  const SE2 new_step = nodes.Between(a.to, b.to);
  const Eigen::Vector3d error =
      ((old_step * b.T_from_to).Inverse() * (a.T_from_to * new_step)).coordinates();
  const Eigen::Matrix3d covariance =
      Transported(new_step.Inverse(), a.covariance) + b.covariance +
      ChainCovariance(nodes.PathLength(a.to, b.to)) +
      Transported(b.T_from_to.Inverse(),
                  ChainCovariance(std::min(nodes.PathLength(a.from, b.from), 50.0)));
  return std::exp(-error.dot(covariance.ldlt().solve(error)) / 6.0);
}

std::vector<int> LoopCloser::Verify(const Nodes& nodes) {
  const int newest = nodes.size() - 1;
  std::erase_if(pool_, [&](int index) {
    ClosureRecord& old = record(index);
    if (newest - old.to <= options_.horizon_nodes) return false;
    if (old.outcome == ClosureOutcome::kPending) old.outcome = ClosureOutcome::kInconsistent;
    return true;
  });
  const int n = static_cast<int>(pool_.size());
  if (n < options_.min_agreeing) return {};
  Eigen::MatrixXd agreement = Eigen::MatrixXd::Identity(n, n);
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < i; ++k) {
      agreement(i, k) = agreement(k, i) =
          Agreement(nodes, record(pool_[static_cast<std::size_t>(k)]),
                    record(pool_[static_cast<std::size_t>(i)]));
    }
  }
  const ConsistentSet set = FindConsistentSet(agreement);
  if (static_cast<int>(set.members.size()) < options_.min_agreeing) return {};
  if (set.separation < options_.min_separation) return {};
  int first = std::numeric_limits<int>::max();
  int last = 0;
  std::vector<int> believed;
  for (int member : set.members) {
    const int index = pool_[static_cast<std::size_t>(member)];
    first = std::min(first, record(index).to);
    last = std::max(last, record(index).to);
    if (record(index).outcome == ClosureOutcome::kPending) believed.push_back(index);
  }
  if (nodes.PathLength(first, last) < options_.min_agreeing_path) return {};
  return believed;
}

std::vector<int> LoopCloser::Close(const Nodes& nodes,
                                   const std::vector<Eigen::Matrix3d>& covariances) {
  const std::size_t before = pool_.size();
  for (const ClosureCandidate& candidate : FindCandidates(nodes, covariances)) {
    Try(nodes, candidate);
  }
  if (pool_.size() == before) return {};
  return Verify(nodes);
}

void LoopCloser::Decide(const std::vector<int>& believed, bool kept) {
  for (int index : believed) {
    record(index).outcome = kept ? ClosureOutcome::kAccepted : ClosureOutcome::kRejected;
  }
  if (kept) return;
  std::erase_if(pool_, [&](int index) {
    return std::find(believed.begin(), believed.end(), index) != believed.end();
  });
}

ClosureRecord* LoopCloser::FindAccepted(int from, int to) {
  // Records are in the order of their newer node.
  const auto first = std::lower_bound(records_.begin(), records_.end(), to,
                                      [](const ClosureRecord& r, int node) { return r.to < node; });
  for (auto it = first; it != records_.end() && it->to == to; ++it) {
    if (it->from == from && it->outcome != ClosureOutcome::kRejected) return &*it;
  }
  return nullptr;
}

void LoopCloser::Reject(int from, int to) {
  if (ClosureRecord* found = FindAccepted(from, to)) found->outcome = ClosureOutcome::kRejected;
}

void LoopCloser::SetChi2(int from, int to, double chi2) {
  if (ClosureRecord* found = FindAccepted(from, to)) found->chi2 = chi2;
}

void LoopCloser::Finish() {
  for (int index : pool_) {
    if (record(index).outcome == ClosureOutcome::kPending) {
      record(index).outcome = ClosureOutcome::kInconsistent;
    }
  }
  pool_.clear();
}

}  // namespace loopgrid
