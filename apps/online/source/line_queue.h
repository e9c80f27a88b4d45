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
  bool terminated = true;  ///< false: the stream ended within it
  bool too_long = false;   ///< it was longer than allowed, and `text` is empty
  std::chrono::steady_clock::time_point arrival{};
};

/// A queue of lines from one source to one mapper, limited in bytes. When the queue is full, the
/// source waits and reads nothing. Then pipes and sockets make the sender wait. No line is dropped.
class LineQueue {
 public:
  explicit LineQueue(std::size_t max_bytes = std::size_t{8} << 20);

  /// Waits for room. False if the queue is closed. Called by the source's thread.
  bool Push(ReceivedLine line);

  /// Waits until Pop() would return at once. False if that takes longer than `patience`.
  bool Wait(std::chrono::milliseconds patience);

  /// Waits for a line. False at the end: the queue is closed and empty.
  bool Pop(ReceivedLine* line);

  /// Closes the queue: Push() takes no more lines, but Pop() returns those in the queue. The source
  /// calls it at its end. A mapper that stops early has to call it too, because the source may be
  /// waiting for room. Any thread may call it.
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
