#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace loopgrid {

/// Threads that wait for work. One thread may use a pool at a time.
class WorkerPool {
 public:
  /// `threads` counts the caller; less than 1 is taken as 1. There are fewer if the system does not
  /// give as many.
  explicit WorkerPool(int threads);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  int threads() const { return static_cast<int>(workers_.size()) + 1; }

  /// Splits [0, count) into parts, calls work(begin, end) for each of them on the threads, and
  /// returns when all calls have returned. The parts depend on the number of threads, so the result
  /// for an index must not depend on the part that it is in. `work` must not throw.
  void Run(std::size_t count, const std::function<void(std::size_t, std::size_t)>& work);

 private:
  void Serve(std::size_t part);
  void RunPart(std::size_t part) const;

  std::mutex mutex_;
  std::condition_variable start_;
  std::condition_variable done_;
  const std::function<void(std::size_t, std::size_t)>* work_ = nullptr;
  std::size_t count_ = 0;
  int round_ = 0;
  std::size_t busy_ = 0;
  bool is_closing_ = false;
  std::vector<std::thread> workers_;
};

}  // namespace loopgrid
