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

/// Counters and messages of a source's thread, which other threads may read.
class SharedCounters {
 public:
  void Count(std::int64_t SourceCounters::*counter) {
    const std::lock_guard lock(mutex_);
    ++(counters_.*counter);
  }

  /// Notes a problem for the user, unless the same one was noted before and the source has not
  /// worked since.
  void Note(const std::string& problem) {
    const std::lock_guard lock(mutex_);
    counters_.last_problem = problem;
    if (notices_.size() < kMaxNotices && noted_.insert(problem).second) {
      notices_.push_back(problem);
    }
  }

  /// Call when the source works: the same problems may then be noted again.
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
