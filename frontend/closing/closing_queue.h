#pragma once

#include <condition_variable>
#include <deque>
#include <future>
#include <mutex>
#include <thread>

#include "frontend/closing/loop_closing.h"

namespace loopgrid {

/// Closes loops behind the back of tracking: nodes go in, and what became of each comes out in the
/// same order, whenever it is asked for.
class ClosingQueue {
 public:
  /// `threaded`: on a thread of its own; else at the moment that a result is asked for.
  explicit ClosingQueue(bool threaded);
  ~ClosingQueue();
  ClosingQueue(const ClosingQueue&) = delete;
  ClosingQueue& operator=(const ClosingQueue&) = delete;

  void Submit(NewNode node);

  /// How many nodes have not been taken out yet.
  int size() const { return static_cast<int>(results_.size()); }

  /// Waits for what became of the oldest of them. Throws what its treatment threw.
  ClosingNews Take();

  /// See LoopClosing::Finish(). All nodes have to be taken out before.
  ClosingNews Finish();

 private:
  void Serve();

  LoopClosing closing_;
  std::deque<std::future<ClosingNews>> results_;
  std::mutex mutex_;
  std::condition_variable news_;
  std::deque<std::packaged_task<ClosingNews()>> tasks_;
  bool is_ending_ = false;
  std::thread thread_;
};

}  // namespace loopgrid
