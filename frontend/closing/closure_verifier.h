#pragma once

#include <span>
#include <vector>

#include "frontend/closing/closing_options.h"
#include "frontend/closing/closure.h"
#include "frontend/closing/closure_list.h"
#include "frontend/closing/nodes.h"

namespace loopgrid {

/// Decides which proposed closures are accepted: those that agree with several others. Two closures
/// agree if the loop of both and the paths between their nodes ends where it began.
class ClosureVerifier {
 public:
  explicit ClosureVerifier(const ClosureVerifierOptions& options = {}) : options_(options) {}

  /// Adds a pending closure to the pool of closures that are compared with each other.
  void Add(ClosureId id) { pool_.push_back(id); }

  /// The pending closures to be accepted now. `anywhere`: the session is not localized, so the
  /// poses in the graph do not support them, and more of them have to agree. Closures that have
  /// waited too long become inconsistent.
  std::vector<ClosureId> Verify(const Nodes& nodes, bool anywhere, ClosureList* closures);

  /// Removes closures that the graph did not keep, so that they no longer support others.
  void Forget(std::span<const ClosureId> ids);

  /// Empties the pool. Closures that are still pending become inconsistent.
  void Expire(ClosureList* closures);

 private:
  void ExpireOld(int newest, ClosureList* closures);
  Eigen::Matrix3d PathCovariance(double path) const;
  double Agreement(const Nodes& nodes, const Closure& a, const Closure& b) const;
  Eigen::MatrixXd Agreements(const Nodes& nodes, const ClosureList& closures) const;

  ClosureVerifierOptions options_;
  std::vector<ClosureId> pool_;  // recent closures that are pending or accepted
};

}  // namespace loopgrid
