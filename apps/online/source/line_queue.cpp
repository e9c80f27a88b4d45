#include "apps/online/source/line_queue.h"

#include <utility>

namespace loopgrid {
namespace {

/// The memory of a line. It includes more than the text, so that many empty lines fill the queue
/// too.
std::size_t Cost(const ReceivedLine& line) { return line.text.size() + sizeof(ReceivedLine); }

}  // namespace

LineQueue::LineQueue(std::size_t max_bytes) : max_bytes_(max_bytes) {}

bool LineQueue::Push(ReceivedLine line) {
  const std::size_t cost = Cost(line);
  std::unique_lock lock(mutex_);
  // A line that is larger than the whole queue is taken once the queue is empty.
  const auto has_room = [&] { return closed_ || lines_.empty() || bytes_ + cost <= max_bytes_; };
  if (!has_room()) {
    ++counters_.waits;
    room_.wait(lock, has_room);
  }
  if (closed_) return false;
  ++counters_.lines;
  counters_.bytes += static_cast<std::int64_t>(line.text.size());
  bytes_ += cost;
  lines_.push_back(std::move(line));
  lock.unlock();
  news_.notify_one();
  return true;
}

bool LineQueue::Wait(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  return news_.wait_for(lock, patience, [this] { return closed_ || !lines_.empty(); });
}

bool LineQueue::Pop(ReceivedLine* line) {
  std::unique_lock lock(mutex_);
  news_.wait(lock, [this] { return closed_ || !lines_.empty(); });
  if (lines_.empty()) return false;
  *line = std::move(lines_.front());
  lines_.pop_front();
  bytes_ -= Cost(*line);
  lock.unlock();
  room_.notify_one();
  return true;
}

void LineQueue::Close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  room_.notify_all();
  news_.notify_all();
}

LineQueue::Counters LineQueue::counters() const {
  const std::lock_guard lock(mutex_);
  Counters counters = counters_;
  counters.waiting_lines = lines_.size();
  return counters;
}

}  // namespace loopgrid
