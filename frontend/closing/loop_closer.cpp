#include "frontend/closing/loop_closer.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "frontend/closing/consistency.h"

namespace loopgrid {
namespace {

// A covariance of motions in the frame of b, as motions in the frame of a.
Eigen::Matrix3d Transported(const SE2& T_a_b, const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d A = T_a_b.Adjoint();
  return A * covariance * A.transpose();
}

// What may have gone wrong between two nodes that tracking joined `path` metres apart. More than
// tracking is usually off, so that true closures agree in its bad moments too.
Eigen::Matrix3d ChainCovariance(double path) {
  constexpr double kFarthest = 50.0;  // metres; beyond, the graph says better
  const double metres = std::min(path, kFarthest);
  const double translation = 0.02 + 0.01 * metres;
  const double rotation = 0.005 + 0.002 * metres;
  return Eigen::Vector3d(translation * translation, translation * translation, rotation * rotation)
      .asDiagonal();
}

// Standard deviation of the position in its least certain direction, metres.
double LargestSigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance.topLeftCorner<2, 2>());
  return std::sqrt(solver.eigenvalues()(1));
}

bool IsLikelier(const ClosureCandidate& a, const ClosureCandidate& b) {
  if (a.distance_sigmas != b.distance_sigmas) return a.distance_sigmas < b.distance_sigmas;
  return a.distance < b.distance;
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

std::optional<ClosureCandidate> LoopCloser::Gate(const SE2& T_old_newest,
                                                 const Eigen::Matrix3d& covariance) const {
  const Eigen::Vector2d p = T_old_newest.translation();
  // A motion e of the old node in its own frame moves the newest, seen from there, by -e_xy and
  // turns it by -e_theta.
  Eigen::Matrix<double, 2, 3> J;
  J << -1.0, 0.0, p.y(), 0.0, -1.0, -p.x();
  const Eigen::Matrix2d S = J * covariance * J.transpose() + 1e-6 * Eigen::Matrix2d::Identity();
  ClosureCandidate candidate;
  candidate.distance = p.norm();
  candidate.distance_sigmas = SigmasBeyond(p, options_.view_distance, S);
  if (!(candidate.distance_sigmas <= options_.gate_sigmas)) return std::nullopt;
  candidate.window = {
      options_.gate_sigmas * std::sqrt(S(0, 0)) + options_.window_margin,
      options_.gate_sigmas * std::sqrt(S(1, 1)) + options_.window_margin,
      options_.gate_sigmas * std::sqrt(covariance(2, 2)) + options_.window_angle_margin};
  return candidate;
}

std::vector<ClosureCandidate> LoopCloser::FindCandidates(
    const Nodes& nodes, const std::vector<Eigen::Matrix3d>& covariances) const {
  const int newest = nodes.size() - 1;
  const int last_old = std::min(newest - options_.recent_nodes,
                                nodes.Around(newest, options_.recent_path).first - 1);
  // Of the consecutive nodes of one pass the likeliest, of those the nearest.
  std::vector<ClosureCandidate> passes;
  int last_hit = -1 - options_.same_pass;
  for (int j = localized_ ? 0 : session_; j <= last_old; ++j) {
    std::optional<ClosureCandidate> candidate =
        Gate(nodes.Between(j, newest), covariances[static_cast<std::size_t>(j)]);
    if (!candidate) continue;
    candidate->node = j;
    if (passes.empty() || j - last_hit > options_.same_pass) {
      passes.push_back(*candidate);
    } else if (IsLikelier(*candidate, passes.back())) {
      passes.back() = *candidate;
    }
    last_hit = j;
  }
  std::stable_sort(passes.begin(), passes.end(),
                   [](const ClosureCandidate& a, const ClosureCandidate& b) {
                     return a.distance_sigmas < b.distance_sigmas;
                   });
  if (static_cast<int>(passes.size()) > options_.max_candidates) {
    passes.resize(static_cast<std::size_t>(options_.max_candidates));
  }
  return passes;
}

std::vector<Eigen::Vector2f> LoopCloser::Surroundings(const Nodes& nodes, double path) const {
  const int newest = nodes.size() - 1;
  const LocalMap map = nodes.MapOf(nodes.Around(newest, path), newest, options_.map_radius);
  std::vector<Eigen::Vector2f> points;
  points.reserve(map.surfels().size());
  for (const Surfel& s : map.surfels()) points.push_back(s.position);
  return points;
}

ClosureOutcome LoopCloser::Judge(const ClosureMatch& match) const {
  if (!match.found) return ClosureOutcome::kLowScore;
  if (match.second_score > options_.max_second_share * match.score) {
    return ClosureOutcome::kAmbiguous;
  }
  if (match.denied_share > options_.max_denied_share) return ClosureOutcome::kContradicted;
  if (LargestSigma(match.covariance) > options_.max_sigma) return ClosureOutcome::kUnconstrained;
  return ClosureOutcome::kPending;
}

void LoopCloser::Try(const Nodes& nodes, double timestamp, const ClosureCandidate& candidate) {
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
  record.timestamp = timestamp;
  record.distance_sigmas = candidate.distance_sigmas;
  Record(match, record);
}

void LoopCloser::TryEverywhere(const Nodes& nodes, double timestamp) {
  const int newest = nodes.size() - 1;
  if (!finder_) finder_.emplace(nodes, session_, options_.place_finder);
  const int age = newest - session_;
  const int steps =
      age > options_.eager_nodes
          ? options_.max_node_steps
          : std::clamp(finder_->places() / options_.places_a_node, 1, options_.max_node_steps);
  if (age % steps != 0) return;
  const std::optional<FoundPlace> found = finder_->Find(
      nodes.scan(newest), Surroundings(nodes, options_.surroundings_path), options_.matcher);
  if (!found) return;
  ClosureRecord record;
  record.from = found->node;
  record.to = newest;
  record.timestamp = timestamp;
  Record(found->match, record);
}

void LoopCloser::Record(const ClosureMatch& match, ClosureRecord record) {
  record.score = match.score;
  record.second_score = match.second_score;
  record.T_from_to = match.T_map_robot;
  record.covariance = match.covariance;
  record.inlier_share = match.inlier_share;
  record.denied_share = match.denied_share;
  record.outcome = Judge(match);
  const int index = static_cast<int>(records_.size());
  if (record.outcome == ClosureOutcome::kPending) pool_.push_back(index);
  records_.push_back(record);
  changed_.insert(index);
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
      Transported(b.T_from_to.Inverse(), ChainCovariance(nodes.PathLength(a.from, b.from)));
  // The expected chi-square is 3: an honest pair scores about exp(-1/2).
  return std::exp(-error.dot(covariance.ldlt().solve(error)) / 6.0);
}

std::vector<int> LoopCloser::Verify(const Nodes& nodes) {
  const int newest = nodes.size() - 1;
  std::erase_if(pool_, [&](int index) {
    const ClosureRecord& old = record(index);
    if (newest - old.to <= options_.horizon_nodes) return false;
    if (old.outcome == ClosureOutcome::kPending) {
      Change(index).outcome = ClosureOutcome::kInconsistent;
    }
    return true;
  });
  const int n = static_cast<int>(pool_.size());
  const int least = localized_ ? options_.min_agreeing : options_.min_agreeing_anywhere;
  if (n < least) return {};
  Eigen::MatrixXd agreement = Eigen::MatrixXd::Identity(n, n);
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < i; ++k) {
      agreement(i, k) = agreement(k, i) =
          Agreement(nodes, record(pool_[static_cast<std::size_t>(k)]),
                    record(pool_[static_cast<std::size_t>(i)]));
    }
  }
  const ConsistentSet set = FindConsistentSet(agreement);
  if (static_cast<int>(set.members.size()) < least) return {};
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

std::vector<int> LoopCloser::Close(const Nodes& nodes, double timestamp,
                                   const std::vector<Eigen::Matrix3d>& covariances) {
  const std::size_t before = pool_.size();
  for (const ClosureCandidate& candidate : FindCandidates(nodes, covariances)) {
    Try(nodes, timestamp, candidate);
  }
  if (!localized_) TryEverywhere(nodes, timestamp);
  if (pool_.size() == before) return {};
  return Verify(nodes);
}

void LoopCloser::Decide(const std::vector<int>& believed, bool kept) {
  for (int index : believed) {
    Change(index).outcome = kept ? ClosureOutcome::kAccepted : ClosureOutcome::kRejected;
  }
  if (kept) return;
  std::erase_if(pool_, [&](int index) {
    return std::find(believed.begin(), believed.end(), index) != believed.end();
  });
}

ClosureRecord& LoopCloser::Change(int index) {
  changed_.insert(index);
  return records_[static_cast<std::size_t>(index)];
}

std::optional<int> LoopCloser::FindAccepted(int from, int to) const {
  // Records are in the order of their newer node.
  const auto first = std::lower_bound(records_.begin(), records_.end(), to,
                                      [](const ClosureRecord& r, int node) { return r.to < node; });
  for (auto it = first; it != records_.end() && it->to == to; ++it) {
    const bool in_graph =
        it->outcome == ClosureOutcome::kAccepted || it->outcome == ClosureOutcome::kPending;
    if (it->from == from && in_graph) return static_cast<int>(it - records_.begin());
  }
  return std::nullopt;
}

void LoopCloser::Reject(int from, int to) {
  if (const auto found = FindAccepted(from, to)) {
    Change(*found).outcome = ClosureOutcome::kRejected;
  }
}

void LoopCloser::SetChi2(int from, int to, double chi2) {
  const auto found = FindAccepted(from, to);
  if (found && record(*found).chi2 != chi2) Change(*found).chi2 = chi2;
}

void LoopCloser::StartSession(int first_node) {
  ExpirePending();
  session_ = first_node;
  localized_ = false;
  finder_.reset();
}

void LoopCloser::SetLocalized() {
  localized_ = true;
  finder_.reset();
}

void LoopCloser::ExpirePending() {
  for (int index : pool_) {
    if (record(index).outcome == ClosureOutcome::kPending) {
      Change(index).outcome = ClosureOutcome::kInconsistent;
    }
  }
  pool_.clear();
}

void LoopCloser::Finish() { ExpirePending(); }

}  // namespace loopgrid
