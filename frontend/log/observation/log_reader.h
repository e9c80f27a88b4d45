#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "frontend/log/observation/observation.h"

namespace loopgrid {

/// What a reader met so far.
struct LogStatistics {
  std::int64_t lines = 0;       ///< lines (CARMEN) or objects (rawlog) seen
  std::int64_t scans = 0;       ///< observations given out
  std::int64_t odometry = 0;    ///< odometry entries
  std::int64_t parameters = 0;  ///< PARAM lines about a laser
  std::int64_t ignored = 0;     ///< known to carry nothing for us: comments, SYNC, unknown tags
  std::int64_t malformed = 0;   ///< skipped because something was wrong with them
  std::vector<std::string> first_problems;  ///< `file:line: ...` of the first few malformed ones
};

struct LogReaderOptions {
  bool strict = false;  ///< stop at the first malformed entry with an Error instead of skipping it
  int max_reported_problems = 5;  ///< how many problems `first_problems` keeps
};

/// A log, read one observation after the other in constant memory. The order of the file is taken
/// for the order of acquisition. Time stamps are passed on as they are; nothing is sorted by them.
class LogReader {
 public:
  virtual ~LogReader() = default;

  /// The next observation, or false at the end of the log. A file that breaks off (cut or corrupt
  /// gzip data, a damaged rawlog) ends there, which counts as malformed. Throws Error (kInput) if
  /// not even its beginning can be read, or in strict mode at the first malformed entry.
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
