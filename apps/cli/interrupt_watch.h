#pragma once

#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>
#include <thread>
#include <utility>
#include <vector>

namespace loopgrid {

/// Calls handlers when SIGINT, SIGTERM or SIGHUP arrives, as long as the object exists: the first
/// signal calls the first handler, and so on. Handlers run on a thread of their own, also while the
/// rest of the program is busy. After the last handler the program ends with the status 128 + the
/// signal's number. A further signal while the last handler runs ends the program at once. The same
/// signal within a second of the last one is ignored: some programs send it twice. Signals that are
/// ignored when the program starts (nohup, background jobs) stay ignored. Has to be made before any
/// other thread.
class InterruptWatch {
 public:
  /// At least one handler.
  explicit InterruptWatch(std::vector<std::function<void()>> handlers);

  /// The program ends at the first signal, after `clean_up`.
  explicit InterruptWatch(std::function<void()> clean_up)
      : InterruptWatch(std::vector{std::move(clean_up)}) {}
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

 private:
  using Clock = std::chrono::steady_clock;

  void Watch();
  int WaitForSignal();  // 0: the watch is over
  void KillAtNextSignal();

  std::vector<std::function<void()>> handlers_;
  sigset_t watched_;
  sigset_t mask_before_;
  std::atomic<bool> stopping_ = false;
  int last_signal_ = 0;  // of the watching thread
  Clock::time_point last_arrival_;
  std::thread thread_;
};

}  // namespace loopgrid
