#pragma once

#include <string_view>

#include "apps/online/source/line_queue.h"
#include "apps/online/source/line_splitter.h"

namespace loopgrid {

/// Takes the bytes that a source reads, splits them into lines, stamps each line with the time, and
/// pushes it to the queue. The destructor closes the queue.
class LineInlet {
 public:
  explicit LineInlet(LineQueue* queue) : queue_(queue) {}
  ~LineInlet() { queue_->Close(); }
  LineInlet(const LineInlet&) = delete;
  LineInlet& operator=(const LineInlet&) = delete;

  /// Takes bytes that have just arrived. Waits while the queue is full. False if it is closed.
  bool Add(std::string_view bytes);

  /// Call at the end of the stream: pushes the rest of it, as a line that is not terminated. Bytes
  /// added after that begin a new stream. False if the queue is closed.
  bool Finish();

  /// Whether the last Add() completed a line.
  bool completed_line() const { return completed_line_; }

 private:
  LineQueue* queue_;
  LineSplitter splitter_;
  bool completed_line_ = false;
};

}  // namespace loopgrid
