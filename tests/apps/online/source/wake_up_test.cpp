#include "apps/online/source/wake_up.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <thread>

namespace loopgrid {
namespace {

TEST(WakeUp, StaysSignalledForAllWhoAsk) {
  const WakeUp wake_up;
  EXPECT_FALSE(wake_up.signalled());
  wake_up.Signal();
  wake_up.Signal();
  EXPECT_TRUE(wake_up.signalled());
  EXPECT_TRUE(wake_up.signalled());
}

TEST(WakeUp, EndsAWaitOfAnotherThread) {
  const WakeUp wake_up;
  std::thread waiting([&] {
    pollfd descriptor = {wake_up.descriptor(), POLLIN, 0};
    EXPECT_EQ(poll(&descriptor, 1, 60'000), 1);
  });
  wake_up.Signal();
  waiting.join();
}

}  // namespace
}  // namespace loopgrid
