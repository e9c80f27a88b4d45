#include "backend/base/worker_pool.h"

#include <system_error>

namespace loopgrid {

WorkerPool::WorkerPool(int threads) {
  try {
    for (int i = 1; i < threads; ++i) {
      workers_.emplace_back([this, i] { Serve(static_cast<std::size_t>(i)); });
    }
  } catch (const std::system_error&) {
    // The system gives no more threads: those that are there do the work.
  }
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard lock(mutex_);
    is_closing_ = true;
  }
  start_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void WorkerPool::Run(std::size_t count, const std::function<void(std::size_t, std::size_t)>& work) {
  if (workers_.empty()) return work(0, count);
  {
    const std::lock_guard lock(mutex_);
    work_ = &work;
    count_ = count;
    busy_ = workers_.size();
    ++round_;
  }
  start_.notify_all();
  RunPart(0);
  std::unique_lock lock(mutex_);
  done_.wait(lock, [this] { return busy_ == 0; });
}

void WorkerPool::Serve(std::size_t part) {
  int served = 0;
  while (true) {
    {
      std::unique_lock lock(mutex_);
      start_.wait(lock, [&] { return is_closing_ || round_ != served; });
      if (is_closing_) return;
      served = round_;
    }
    RunPart(part);
    const std::lock_guard lock(mutex_);
    if (--busy_ == 0) done_.notify_one();
  }
}

void WorkerPool::RunPart(std::size_t part) const {
  const std::size_t parts = workers_.size() + 1;
  (*work_)(count_ * part / parts, count_ * (part + 1) / parts);
}

}  // namespace loopgrid
