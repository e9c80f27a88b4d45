#pragma once

#include <cstdint>
#include <string>

#include "apps/live/online_update.h"
#include "apps/online/latency_histogram.h"
#include "apps/online/source/line_queue.h"
#include "apps/online/source/line_source.h"
#include "frontend/log/observation/log_reader.h"

namespace loopgrid {

/// The state of a running session, for status.json.
struct OnlineStatus {
  std::string source;
  std::int64_t scans = 0;
  std::int64_t nodes = 0;
  std::int64_t constraints = 0;
  std::int64_t closures_tried = 0;
  std::int64_t closures_accepted = 0;
  std::int64_t unmatched = 0;  ///< scans that odometry alone placed
  bool localized = true;
  LatencyHistogram latency;  ///< of the scans that came since the start
  LogStatistics log;
  LineQueue::Counters queue;
  SourceCounters counters;
};

/// status.json.
std::string FormatStatus(const OnlineStatus& status);

}  // namespace loopgrid
