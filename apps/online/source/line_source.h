#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/online/source/line_queue.h"

namespace loopgrid {

/// What a source met so far; what does not apply to its kind stays 0.
struct SourceCounters {
  std::int64_t connections = 0;  ///< senders that were listened to, one after the other
  std::int64_t refused = 0;      ///< senders turned away: another one was sending, or no log came
  std::int64_t failures = 0;     ///< attempts to connect that failed
  std::int64_t rotations = 0;    ///< times a new file took the place of the one that was followed
  std::int64_t truncations = 0;  ///< times that file shrank and was read from its beginning again
  std::string last_problem;      ///< what went wrong last; empty if nothing did
};

/// Where the lines of a log come from while the robot drives: standard input, a growing file, a
/// socket. Constructors open what they can, so that errors come early.
class LineSource {
 public:
  virtual ~LineSource() = default;

  /// Reads until the stream ends or Stop(), pushing what it gets, or until the queue is closed.
  /// Closes the queue before it returns or throws. Runs on a thread of its own, once. Throws
  /// Error (kInput) if the source cannot be read.
  virtual void Run(LineQueue* queue) = 0;

  /// Makes Run() return soon: lines received so far are still pushed, which takes somebody to pop
  /// them, or to close the queue. Any thread may call it, also before Run().
  virtual void Stop() = 0;

  /// For messages: "standard input", a path, an address.
  virtual std::string name() const = 0;

  /// Any thread may call it.
  virtual SourceCounters counters() const { return {}; }

  /// What has gone wrong since the last call, a line each, for the user. A problem that lasts, or
  /// comes again before the source has worked, is told once. Any thread may call it.
  virtual std::vector<std::string> TakeNotices() { return {}; }
};

}  // namespace loopgrid
