#include "frontend/closing/closing_queue.h"

#include <utility>

namespace loopgrid {

ClosingQueue::ClosingQueue(bool threaded) {
  if (threaded) thread_ = std::thread([this] { Serve(); });
}

ClosingQueue::~ClosingQueue() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  news_.notify_one();
  thread_.join();
}

void ClosingQueue::Submit(NewNode node) {
  auto treat = [this, node = std::move(node)] { return closing_.Add(node); };
  if (!thread_.joinable()) {
    results_.push_back(std::async(std::launch::deferred, std::move(treat)));
    return;
  }
  std::packaged_task<ClosingNews()> task(std::move(treat));
  results_.push_back(task.get_future());
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  news_.notify_one();
}

ClosingNews ClosingQueue::Take() {
  std::future<ClosingNews> result = std::move(results_.front());
  results_.pop_front();
  return result.get();
}

ClosingNews ClosingQueue::Finish() { return closing_.Finish(); }

void ClosingQueue::Serve() {
  std::unique_lock lock(mutex_);
  while (true) {
    news_.wait(lock, [this] { return is_ending_ || !tasks_.empty(); });
    if (is_ending_) return;
    std::packaged_task<ClosingNews()> task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    lock.lock();
  }
}

}  // namespace loopgrid
