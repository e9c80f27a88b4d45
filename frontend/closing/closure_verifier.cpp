#include "frontend/closing/closure_verifier.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "frontend/closing/consistency.h"

namespace loopgrid {
namespace {

// Transforms a covariance from the frame of b to the frame of a.
Eigen::Matrix3d Transported(const SE2& T_a_b, const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d A = T_a_b.Adjoint();
  return A * covariance * A.transpose();
}

void ExpireIfPending(ClosureId id, ClosureList* closures) {
  if ((*closures)[id].outcome != ClosureOutcome::kPending) return;
  closures->SetOutcome(id, ClosureOutcome::kInconsistent);
}

}  // namespace

std::vector<ClosureId> ClosureVerifier::Verify(const Nodes& nodes, bool anywhere,
                                               ClosureList* closures) {
  ExpireOld(nodes.size() - 1, closures);
  const int least = anywhere ? options_.min_agreeing_anywhere : options_.min_agreeing;
  if (std::ssize(pool_) < least) return {};
  const ConsistentSet set = FindConsistentSet(Agreements(nodes, *closures));
  if (std::ssize(set.members) < least || set.separation < options_.min_separation) return {};
  int first = std::numeric_limits<int>::max();
  int last = 0;
  std::vector<ClosureId> believed;
  for (const int member : set.members) {
    const Closure& closure = (*closures)[pool_[static_cast<std::size_t>(member)]];
    first = std::min(first, closure.to);
    last = std::max(last, closure.to);
    if (closure.outcome == ClosureOutcome::kPending) believed.push_back(closure.id);
  }
  if (nodes.PathLength(first, last) < options_.min_agreeing_path) return {};
  return believed;
}

void ClosureVerifier::ExpireOld(int newest, ClosureList* closures) {
  std::erase_if(pool_, [&](ClosureId id) {
    if (newest - (*closures)[id].to <= options_.horizon_nodes) return false;
    ExpireIfPending(id, closures);
    return true;
  });
}

void ClosureVerifier::Forget(std::span<const ClosureId> ids) {
  std::erase_if(pool_,
                [&](ClosureId id) { return std::find(ids.begin(), ids.end(), id) != ids.end(); });
}

void ClosureVerifier::Expire(ClosureList* closures) {
  for (const ClosureId id : pool_) ExpireIfPending(id, closures);
  pool_.clear();
}

// Covariance of the graph's error between two nodes that are `path` metres of travel apart. It is
// larger than the usual error of tracking, so that right closures agree also where tracking is
// worse than usual.
Eigen::Matrix3d ClosureVerifier::PathCovariance(double path) const {
  const double metres = std::min(path, options_.farthest_path);
  const double translation =
      options_.sigma_translation + options_.sigma_translation_per_metre * metres;
  const double rotation = options_.sigma_rotation + options_.sigma_rotation_per_metre * metres;
  return Eigen::Vector3d(translation * translation, translation * translation, rotation * rotation)
      .asDiagonal();
}

double ClosureVerifier::Agreement(const Nodes& nodes, const Closure& a, const Closure& b) const {
  // Both ways from old a to new b: old a -> new a -> new b, and old a -> old b -> new b.
  const SE2 old_step = nodes.Between(a.from, b.from);
  const SE2 new_step = nodes.Between(a.to, b.to);
  const Eigen::Vector3d error =
      ((old_step * b.T_from_to).Inverse() * (a.T_from_to * new_step)).coordinates();
  const Eigen::Matrix3d covariance =
      Transported(new_step.Inverse(), a.covariance) + b.covariance +
      PathCovariance(nodes.PathLength(a.to, b.to)) +
      Transported(b.T_from_to.Inverse(), PathCovariance(nodes.PathLength(a.from, b.from)));
  // chi2 divided by its expectation 3. Two right closures score about exp(-1/2).
  return std::exp(-error.dot(covariance.ldlt().solve(error)) / 6.0);
}

Eigen::MatrixXd ClosureVerifier::Agreements(const Nodes& nodes, const ClosureList& closures) const {
  const auto n = static_cast<Eigen::Index>(pool_.size());
  Eigen::MatrixXd agreement = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index k = 0; k < i; ++k) {
      agreement(i, k) = agreement(k, i) =
          Agreement(nodes, closures[pool_[static_cast<std::size_t>(k)]],
                    closures[pool_[static_cast<std::size_t>(i)]]);
    }
  }
  return agreement;
}

}  // namespace loopgrid
