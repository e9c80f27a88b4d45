#include "frontend/closing/node_queue.h"

#include <utility>

namespace loopgrid {

NodeQueue::NodeQueue(bool threaded, const ClosingOptions& options) : pipeline_(options) {
  if (threaded) thread_ = std::thread([this] { Serve(); });
}

NodeQueue::~NodeQueue() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void NodeQueue::Submit(NewNode node) {
  auto treat = [this, node = std::move(node)] { return pipeline_.Add(node); };
  if (!thread_.joinable()) {
    updates_.push_back(std::async(std::launch::deferred, std::move(treat)));
    return;
  }
  std::packaged_task<GraphUpdate()> task(std::move(treat));
  updates_.push_back(task.get_future());
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  wake_.notify_one();
}

GraphUpdate NodeQueue::Take() {
  std::future<GraphUpdate> update = std::move(updates_.front());
  updates_.pop_front();
  return update.get();
}

GraphUpdate NodeQueue::Finish() { return pipeline_.Finish(); }

void NodeQueue::Serve() {
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return is_ending_ || !tasks_.empty(); });
    if (is_ending_) return;
    std::packaged_task<GraphUpdate()> task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    lock.lock();
  }
}

}  // namespace loopgrid
