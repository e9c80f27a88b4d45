#pragma once

#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>
#include <thread>
#include <utility>
#include <vector>

namespace loopgrid {

/// While one of these lives, SIGINT, SIGTERM and SIGHUP call the handlers on a thread of its own,
/// whatever the rest of the program is busy with: the first signal the first handler, and so on.
/// After the last one the program ends with 128 + the signal's number; a further signal while that
/// one is at work kills at once. The same signal again within a second is the same one: it is
/// ignored. Signals that whoever started the program ignores (nohup, background jobs) stay ignored.
/// Make it before any other thread.
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
