#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "apps/online/source/line_source.h"

namespace loopgrid {

/// What a source's thread counts and reports, for other threads to read.
class SharedCounters {
 public:
  void Count(std::int64_t SourceCounters::*counter) {
    const std::lock_guard lock(mutex_);
    ++(counters_.*counter);
  }

  /// Something went wrong. It becomes a notice for the user, unless the same problem was noted
  /// before and the source has not recovered since.
  void Note(const std::string& problem) {
    const std::lock_guard lock(mutex_);
    counters_.last_problem = problem;
    if (notices_.size() < kMaxNotices && noted_.insert(problem).second) {
      notices_.push_back(problem);
    }
  }

  /// The source works: when a problem comes back, the user is told again.
  void Recover() {
    const std::lock_guard lock(mutex_);
    noted_.clear();
  }

  /// The notices since the last call.
  std::vector<std::string> TakeNotices() {
    const std::lock_guard lock(mutex_);
    return std::exchange(notices_, {});
  }

  SourceCounters Snapshot() const {
    const std::lock_guard lock(mutex_);
    return counters_;
  }

 private:
  static constexpr std::size_t kMaxNotices = 100;  // if nobody takes them

  mutable std::mutex mutex_;
  SourceCounters counters_;
  std::set<std::string> noted_;  // since the source worked last
  std::vector<std::string> notices_;
};

}  // namespace loopgrid
