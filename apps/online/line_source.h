#pragma once

#include "apps/online/line_queue.h"

namespace loopgrid {

/// Where the lines of a log come from while the robot drives: standard input, a growing file, a
/// socket.
class LineSource {
 public:
  virtual ~LineSource() = default;

  /// Reads until the stream ends or Stop(), pushing what it gets. Closes the queue before it
  /// returns. Runs on a thread of its own. Throws Error (kInput) if the source cannot be read.
  virtual void Run(LineQueue* queue) = 0;

  /// Makes Run() return soon: lines received so far are still pushed. Any thread may call it.
  virtual void Stop() = 0;

  /// For messages: "standard input", a path, an address.
  virtual std::string name() const = 0;
};

}  // namespace loopgrid
