#pragma once

#include <span>
#include <vector>

#include "frontend/closing/closing_options.h"
#include "frontend/closing/closure.h"
#include "frontend/closing/closure_list.h"
#include "frontend/closing/nodes.h"

namespace loopgrid {

/// Believes proposed closures once several agree with each other: a loop of two closures and the
/// ways between their nodes has to come back to where it began.
class ClosureVerifier {
 public:
  explicit ClosureVerifier(const ClosureVerifierOptions& options = {}) : options_(options) {}

  /// Takes a pending closure into the pool of those that can agree.
  void Add(ClosureId id) { pool_.push_back(id); }

  /// The pending closures that are to be believed now. `anywhere`: the session is not localized,
  /// nothing but their agreement speaks for them. Those that have waited too long become
  /// inconsistent.
  std::vector<ClosureId> Verify(const Nodes& nodes, bool anywhere, ClosureList* closures);

  /// Closures that the graph did not keep no longer support others.
  void Forget(std::span<const ClosureId> ids);

  /// Empties the pool; what is still pending has found no others that agree with it.
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
