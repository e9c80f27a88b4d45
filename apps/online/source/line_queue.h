#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>

namespace loopgrid {

/// A line of the stream, without its end (LF or CRLF).
struct ReceivedLine {
  std::string text{};
  bool terminated = true;  ///< false: the stream broke off within it
  bool too_long = false;   ///< it was longer than allowed, and `text` is empty
  std::chrono::steady_clock::time_point arrival{};
};

/// Lines on their way from one source to one mapper, bounded in bytes. A full queue makes the
/// source wait: it stops reading, and pipes and sockets slow their sender down. Nothing is dropped.
class LineQueue {
 public:
  explicit LineQueue(std::size_t max_bytes = std::size_t{8} << 20);

  /// Waits for room; false once the queue is closed. For the source's thread.
  bool Push(ReceivedLine line);

  /// Waits until Pop() need not wait; false if that took longer than `patience`.
  bool Wait(std::chrono::milliseconds patience);

  /// Waits for a line; false at the end: Close() was called and all lines are out.
  bool Pop(ReceivedLine* line);

  /// No more lines are taken; those in the queue can still be popped. The source calls it when it
  /// ends. A mapper that gives up calls it too, because the source may be waiting for room. Any
  /// thread may call it.
  void Close();

  struct Counters {
    std::int64_t lines = 0;         ///< pushed
    std::int64_t bytes = 0;         ///< pushed, of text
    std::int64_t waits = 0;         ///< how often the source had to wait
    std::size_t waiting_lines = 0;  ///< in the queue now
  };
  Counters counters() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable room_;
  std::condition_variable news_;
  std::deque<ReceivedLine> lines_;
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;  // in the queue
  bool closed_ = false;
  Counters counters_;
};

}  // namespace loopgrid
