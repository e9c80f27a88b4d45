#include "apps/cli/interrupt_watch.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>
#include <vector>

namespace loopgrid {
namespace {

using namespace std::chrono_literals;
using ::testing::ExitedWithCode;
using ::testing::KilledBySignal;

void PollUntil(const std::function<bool()>& condition) {
  while (!condition()) std::this_thread::sleep_for(1ms);
}

/// Sends a signal to this process and waits until the watch has received it.
void SendAndWait(int signal) {
  kill(getpid(), signal);
  PollUntil([signal] {
    sigset_t pending;
    sigpending(&pending);
    return sigismember(&pending, signal) == 0;
  });
}

[[noreturn]] void WaitForEnd() {
  while (true) std::this_thread::sleep_for(1s);
}

/// A program with two handlers; the second one ends it.
class WatchedProgram {
 public:
  explicit WatchedProgram(std::function<void()> last = [] {})
      : watch_(std::vector<std::function<void()>>{[this] { ++calls_; },
                                                  [this, last] {
                                                    ++calls_;
                                                    last();
                                                  }}) {
    alarm(60);  // ends a test that fails
  }

  void WaitForCalls(int calls) {
    PollUntil([this, calls] { return calls_ >= calls; });
  }

 private:
  std::atomic<int> calls_ = 0;
  InterruptWatch watch_;
};

TEST(InterruptWatchDeathTest, TheSameSignalTwiceWithinASecondIsOne) {
  const auto program = [] {
    WatchedProgram watched;
    SendAndWait(SIGTERM);
    watched.WaitForCalls(1);
    SendAndWait(SIGTERM);
    SendAndWait(SIGINT);  // another signal, so it is not ignored
    WaitForEnd();
  };
  EXPECT_EXIT(program(), ExitedWithCode(128 + SIGINT), "");
}

TEST(InterruptWatchDeathTest, TheSameSignalLaterIsAnother) {
  const auto program = [] {
    WatchedProgram watched;
    while (true) {
      SendAndWait(SIGTERM);
      std::this_thread::sleep_for(20ms);
    }
  };
  EXPECT_EXIT(program(), ExitedWithCode(128 + SIGTERM), "");
}

TEST(InterruptWatchDeathTest, OnlyAnotherSignalBreaksOffTheLastHandler) {
  const auto program = [] {
    WatchedProgram watched([] { WaitForEnd(); });
    SendAndWait(SIGINT);
    watched.WaitForCalls(1);
    SendAndWait(SIGTERM);
    watched.WaitForCalls(2);
    SendAndWait(SIGTERM);  // ignored, because it is the same one
    SendAndWait(SIGHUP);
    WaitForEnd();
  };
  EXPECT_EXIT(program(), KilledBySignal(SIGHUP), "");
}

TEST(InterruptWatch, EndsWithoutASignal) {
  int calls = 0;
  {
    const InterruptWatch watch([&calls] { ++calls; });
  }
  EXPECT_EQ(calls, 0);
}

}  // namespace
}  // namespace loopgrid
