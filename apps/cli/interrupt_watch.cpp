#include "apps/cli/interrupt_watch.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <thread>
#include <utility>

namespace loopgrid {
namespace {

// Wakes the watching thread so that it ends. Sent to that thread only.
constexpr int kWake = SIGUSR1;

// Programs like timeout(1) send a signal to a process and to its group, so that it comes twice.
constexpr std::chrono::seconds kSameSignal(1);

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
  // Threads inherit the mask, so only the watching thread receives these signals.
  pthread_sigmask(SIG_BLOCK, &watched_, &mask_before_);
  thread_ = std::thread([this] { Watch(); });
}

InterruptWatch::~InterruptWatch() {
  stopping_ = true;
  pthread_kill(thread_.native_handle(), kWake);
  thread_.join();
  pthread_sigmask(SIG_SETMASK, &mask_before_, nullptr);
}

int InterruptWatch::WaitForSignal() {
  while (true) {
    int signal = 0;
    if (sigwait(&watched_, &signal) != 0 || stopping_) return 0;
    const Clock::time_point now = Clock::now();
    if (signal == last_signal_ && now - last_arrival_ < kSameSignal) continue;
    last_signal_ = signal;
    last_arrival_ = now;
    return signal;
  }
}

void InterruptWatch::Watch() {
  for (const auto& handle : handlers_) {
    if (WaitForSignal() == 0) return;
    // From here on the program ends by _exit() only, so this thread need not be joined.
    if (&handle == &handlers_.back()) std::thread([this] { KillAtNextSignal(); }).detach();
    handle();
  }
  _exit(128 + last_signal_);
}

void InterruptWatch::KillAtNextSignal() {
  // kWake is for the other thread, so it is not waited for here.
  sigset_t signals = watched_;
  sigdelset(&signals, kWake);
  int signal = 0;
  do {
    if (sigwait(&signals, &signal) != 0) return;
  } while (signal == last_signal_ && Clock::now() - last_arrival_ < kSameSignal);
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  raise(signal);  // the signal is not blocked any more, so it ends the program
}

}  // namespace loopgrid
