#pragma once

#include <algorithm>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "apps/online/source/line_queue.h"
#include "apps/online/source/line_source.h"
#include "tests/apps/online/wait_until.h"

namespace loopgrid::test_support {

/// A line as text: cut lines end in `~`, and lines that are too long are `(too long)`.
inline std::string Shown(const ReceivedLine& line) {
  return (line.too_long ? "(too long)" : line.text) + (line.terminated ? "" : "~");
}

/// Runs a source on a thread of its own. Another thread collects its lines.
class RunningSource {
 public:
  explicit RunningSource(LineSource* source) : source_(source) {
    reader_ = std::thread([this] { Run(); });
    popper_ = std::thread([this] { Pop(); });
  }
  ~RunningSource() { Stop(); }

  /// Stops the source and waits for its end.
  void Stop() {
    source_->Stop();
    WaitForEnd();
  }

  /// Waits until the stream has ended by itself.
  void WaitForEnd() {
    if (reader_.joinable()) reader_.join();
    if (popper_.joinable()) popper_.join();
  }

  /// All lines so far, as Shown().
  std::vector<std::string> lines() const {
    const std::lock_guard lock(mutex_);
    return lines_;
  }

  /// Waits for `count` lines, for a limited time. Returns all lines so far.
  std::vector<std::string> WaitForLines(std::size_t count) const {
    WaitUntil([&] { return lines().size() >= count; });
    return lines();
  }

  std::size_t Count(const std::string& line) const {
    const std::vector<std::string> all = lines();
    return static_cast<std::size_t>(std::count(all.begin(), all.end(), line));
  }

  /// After the end: the message of the error that Run() threw; empty if none.
  const std::string& problem() const { return problem_; }

 private:
  void Run() {
    try {
      source_->Run(&queue_);
    } catch (const std::exception& error) {
      problem_ = error.what();
    }
  }

  void Pop() {
    ReceivedLine line;
    while (queue_.Pop(&line)) {
      const std::lock_guard lock(mutex_);
      lines_.push_back(Shown(line));
    }
  }

  LineSource* source_;
  LineQueue queue_{std::size_t{1} << 16};
  std::string problem_;
  mutable std::mutex mutex_;
  std::vector<std::string> lines_;
  std::thread reader_;
  std::thread popper_;
};

}  // namespace loopgrid::test_support
