#include "apps/cli/interrupt_watch.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <utility>

namespace loopgrid {
namespace {

// Wakes the watching thread when its work is over; sent to that thread alone.
constexpr int kWake = SIGUSR1;

bool IsIgnored(int signal) {
  struct sigaction action = {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

InterruptWatch::InterruptWatch(std::vector<std::function<void()>> handlers)
    : handlers_(std::move(handlers)) {
  sigemptyset(&watched_);
  sigaddset(&watched_, kWake);
  for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
    if (!IsIgnored(signal)) sigaddset(&watched_, signal);
  }
  // Threads inherit the mask, so that these signals reach nobody but the watching thread.
  pthread_sigmask(SIG_BLOCK, &watched_, &mask_before_);
  thread_ = std::thread([this] { Watch(); });
}

InterruptWatch::~InterruptWatch() {
  stopping_ = true;
  pthread_kill(thread_.native_handle(), kWake);
  thread_.join();
  pthread_sigmask(SIG_SETMASK, &mask_before_, nullptr);
}

void InterruptWatch::Watch() {
  int signal = 0;
  for (const auto& handle : handlers_) {
    if (sigwait(&watched_, &signal) != 0 || stopping_) return;
    if (&handle == &handlers_.back()) {
      // From here on another one kills. kWake does not: the destructor may be sending it just now.
      sigdelset(&watched_, kWake);
      pthread_sigmask(SIG_UNBLOCK, &watched_, nullptr);
    }
    handle();
  }
  _exit(128 + signal);
}

}  // namespace loopgrid
