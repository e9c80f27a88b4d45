#pragma once

#include <cstdint>
#include <mutex>
#include <string>

#include "apps/online/source/line_source.h"

namespace loopgrid {

/// Counters that a source's thread writes and others read.
class SharedCounters {
 public:
  void Count(std::int64_t SourceCounters::*counter) {
    const std::lock_guard lock(mutex_);
    ++(counters_.*counter);
  }

  void Note(const std::string& problem) {
    const std::lock_guard lock(mutex_);
    counters_.last_problem = problem;
  }

  SourceCounters Snapshot() const {
    const std::lock_guard lock(mutex_);
    return counters_;
  }

 private:
  mutable std::mutex mutex_;
  SourceCounters counters_;
};

}  // namespace loopgrid
