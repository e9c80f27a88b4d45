#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/online/source/line_queue.h"

namespace loopgrid {

/// Counters of a source. Those that do not apply to its kind stay 0.
struct SourceCounters {
  std::int64_t connections = 0;  ///< senders that were read from, one after the other
  std::int64_t refused = 0;      ///< senders turned away: another one was sending, or no log came
  std::int64_t failures = 0;     ///< attempts to connect that failed
  std::int64_t rotations = 0;    ///< times a new file took the place of the one that was followed
  std::int64_t truncations = 0;  ///< times that file shrank and was read from its beginning again
  std::string last_problem;      ///< the last problem; empty if there was none
};

/// Where the lines of a log come from while the robot drives: standard input, a growing file, a
/// socket. Constructors open files and addresses, so that errors come before anything is mapped.
class LineSource {
 public:
  virtual ~LineSource() = default;

  /// Reads lines and pushes them until the stream ends, Stop() is called, or the queue is closed.
  /// Closes the queue before it returns or throws. To be called once, on a thread of its own.
  /// Throws Error (kInput) if the source cannot be read.
  virtual void Run(LineQueue* queue) = 0;

  /// Makes Run() return soon. Lines received so far are still pushed, so another thread has to pop
  /// them or to close the queue. Any thread may call it, also before Run().
  virtual void Stop() = 0;

  /// For messages: "standard input", a path, an address.
  virtual std::string name() const = 0;

  /// Any thread may call it.
  virtual SourceCounters counters() const { return {}; }

  /// Messages for the user about problems since the last call. A problem that lasts, or comes again
  /// before the source has worked, is reported once. Any thread may call it.
  virtual std::vector<std::string> TakeNotices() { return {}; }
};

}  // namespace loopgrid
