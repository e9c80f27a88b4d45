#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "frontend/log/observation/observation.h"

namespace loopgrid {

/// Counts of what a reader has read so far.
struct LogStatistics {
  std::int64_t lines = 0;                   ///< lines (CARMEN) or objects (rawlog) seen
  std::int64_t scans = 0;                   ///< observations returned
  std::int64_t odometry = 0;                ///< odometry entries
  std::int64_t parameters = 0;              ///< PARAM lines about a laser
  std::int64_t ignored = 0;                 ///< lines of no use: comments, SYNC, unknown tags
  std::int64_t malformed = 0;               ///< skipped because something was wrong with them
  std::vector<std::string> first_problems;  ///< `file:line: ...` of the first few malformed ones
};

struct LogReaderOptions {
  bool strict = false;  ///< stop at the first malformed entry with an Error instead of skipping it
  int max_reported_problems = 5;  ///< how many problems `first_problems` keeps
};

/// A log, read one observation after the other in constant memory. Observations come in the order
/// of the file. Time stamps are passed on as they are and not used for sorting.
class LogReader {
 public:
  virtual ~LogReader() = default;

  /// The next observation, or false at the end of the log. A file that is cut or damaged (gzip
  /// data, rawlog) ends there; this counts as one malformed entry. Throws Error (kInput) if the
  /// beginning cannot be read, or in strict mode at the first malformed entry.
  virtual bool Next(Observation* observation) = 0;

  virtual const LogStatistics& statistics() const = 0;

  /// Share of the input consumed, 0..1, for progress bars; 0 where the size is unknown.
  virtual double progress() const = 0;
};

/// For readers: counts a malformed entry and keeps its description, or throws it as an Error
/// (kInput) in strict mode.
void CountMalformed(const std::string& problem, const LogReaderOptions& options,
                    LogStatistics* statistics);

}  // namespace loopgrid
