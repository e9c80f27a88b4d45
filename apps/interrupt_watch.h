#pragma once

#include <atomic>
#include <csignal>
#include <functional>
#include <thread>

namespace loopgrid {

/// While one of these lives, SIGINT, SIGTERM and SIGHUP call `clean_up` on a thread of its own,
/// whatever the rest of the program is busy with, and then end the program with 128 + the signal's
/// number. A second signal during `clean_up` kills at once. Signals that whoever started the
/// program ignores (nohup, background jobs) stay ignored. Make it before any other thread.
class InterruptWatch {
 public:
  explicit InterruptWatch(std::function<void()> clean_up);
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

 private:
  void Watch();

  std::function<void()> clean_up_;
  sigset_t watched_;
  sigset_t mask_before_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace loopgrid
