#include "frontend/closing/closure_gate.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

namespace loopgrid {
namespace {

// Distance of `offset` beyond `reach` metres, in sigmas of `covariance`.
double SigmasBeyond(const Eigen::Vector2d& offset, double reach,
                    const Eigen::Matrix2d& covariance) {
  const double length = offset.norm();
  if (length <= reach) return 0.0;
  const Eigen::Vector2d beyond = offset * ((length - reach) / length);
  return std::sqrt(beyond.dot(covariance.ldlt().solve(beyond)));
}

// The old node as a candidate; nothing if the newest node is outside its gate.
std::optional<ClosureCandidate> Gate(const SE2& T_old_newest, const Eigen::Matrix3d& covariance,
                                     const ClosureGateOptions& options) {
  const Eigen::Vector2d p = T_old_newest.translation();
  // A motion e of the old node in its own frame moves the newest, seen from there, by -e_xy and
  // turns it by -e_theta.
  Eigen::Matrix<double, 2, 3> J;
  J << -1.0, 0.0, p.y(), 0.0, -1.0, -p.x();
  const Eigen::Matrix2d S = J * covariance * J.transpose() + 1e-6 * Eigen::Matrix2d::Identity();
  ClosureCandidate candidate;
  candidate.distance = p.norm();
  candidate.distance_sigmas = SigmasBeyond(p, options.view_distance, S);
  if (!(candidate.distance_sigmas <= options.gate_sigmas)) return std::nullopt;
  candidate.window = {
      options.gate_sigmas * std::sqrt(S(0, 0)) + options.window_margin,
      options.gate_sigmas * std::sqrt(S(1, 1)) + options.window_margin,
      options.gate_sigmas * std::sqrt(covariance(2, 2)) + options.window_angle_margin};
  return candidate;
}

bool IsLikelier(const ClosureCandidate& a, const ClosureCandidate& b) {
  if (a.distance_sigmas != b.distance_sigmas) return a.distance_sigmas < b.distance_sigmas;
  return a.distance < b.distance;
}

}  // namespace

std::vector<ClosureCandidate> FindCandidates(const Nodes& nodes, int first_node,
                                             const std::vector<Eigen::Matrix3d>& covariances,
                                             const ClosureGateOptions& options) {
  const int newest = nodes.size() - 1;
  const int last_old =
      std::min(newest - options.recent_nodes, nodes.Around(newest, options.recent_path).first - 1);
  std::vector<ClosureCandidate> passes;
  int last_hit = -1 - options.same_pass;
  for (int j = first_node; j <= last_old; ++j) {
    std::optional<ClosureCandidate> candidate =
        Gate(nodes.Between(j, newest), covariances[static_cast<std::size_t>(j)], options);
    if (!candidate) continue;
    candidate->node = j;
    if (passes.empty() || j - last_hit > options.same_pass) {
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
  if (std::ssize(passes) > options.max_candidates) {
    passes.resize(static_cast<std::size_t>(options.max_candidates));
  }
  return passes;
}

}  // namespace loopgrid
