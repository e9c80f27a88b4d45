#pragma once

#include <set>
#include <utility>
#include <vector>

#include "frontend/closing/closure.h"

namespace loopgrid {

/// Every closure tried so far, in order, and which of them are new or have changed lately.
class ClosureList {
 public:
  /// Gives the closure its id.
  ClosureId Add(Closure closure) {
    closure.id = static_cast<ClosureId>(closures_.size());
    changed_.insert(closure.id);
    closures_.push_back(std::move(closure));
    return closures_.back().id;
  }

  const Closure& operator[](ClosureId id) const { return closures_[static_cast<std::size_t>(id)]; }
  const std::vector<Closure>& all() const { return closures_; }

  void SetOutcome(ClosureId id, ClosureOutcome outcome) {
    closures_[static_cast<std::size_t>(id)].outcome = outcome;
    changed_.insert(id);
  }

  void SetChi2(ClosureId id, double chi2) {
    double& old = closures_[static_cast<std::size_t>(id)].chi2;
    if (old == chi2) return;
    old = chi2;
    changed_.insert(id);
  }

  /// Ids of the closures that are new or have changed since the last call, in order.
  std::set<ClosureId> TakeChanged() { return std::exchange(changed_, {}); }

 private:
  std::vector<Closure> closures_;
  std::set<ClosureId> changed_;
};

}  // namespace loopgrid
