#include "apps/online/source/line_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>

#include "tests/apps/online/wait_until.h"
#include "tests/support/portable_random.h"

namespace loopgrid {
namespace {

using test_support::PortableRandom;
using test_support::WaitUntil;

ReceivedLine Line(std::string text) {
  ReceivedLine line;
  line.text = std::move(text);
  return line;
}

std::string PopText(LineQueue* queue) {
  ReceivedLine line;
  return queue->Pop(&line) ? line.text : "(end)";
}

TEST(LineQueue, GivesLinesInTheirOrderAndAsTheyWere) {
  LineQueue queue;
  ReceivedLine broken = Line("broken");
  broken.terminated = false;
  broken.arrival = std::chrono::steady_clock::time_point(std::chrono::seconds(7));
  ReceivedLine endless;
  endless.too_long = true;
  EXPECT_TRUE(queue.Push(broken));
  EXPECT_TRUE(queue.Push(endless));
  ReceivedLine line;
  ASSERT_TRUE(queue.Pop(&line));
  EXPECT_EQ(line.text, "broken");
  EXPECT_FALSE(line.terminated);
  EXPECT_FALSE(line.too_long);
  EXPECT_EQ(line.arrival, broken.arrival);
  ASSERT_TRUE(queue.Pop(&line));
  EXPECT_TRUE(line.terminated);
  EXPECT_TRUE(line.too_long);
}

TEST(LineQueue, OnceClosedGivesWhatIsInItAndTakesNoMore) {
  LineQueue queue;
  queue.Push(Line("a"));
  queue.Push(Line("b"));
  queue.Close();
  queue.Close();
  EXPECT_FALSE(queue.Push(Line("c")));
  EXPECT_EQ(PopText(&queue), "a");
  EXPECT_EQ(PopText(&queue), "b");
  EXPECT_EQ(PopText(&queue), "(end)");
  EXPECT_EQ(PopText(&queue), "(end)");
  EXPECT_EQ(queue.counters().lines, 2);
}

TEST(LineQueue, TakesALineThatIsLargerThanItself) {
  LineQueue queue(10);
  EXPECT_TRUE(queue.Push(Line(std::string(1'000, 'x'))));
  EXPECT_EQ(PopText(&queue), std::string(1'000, 'x'));
  EXPECT_EQ(queue.counters().waits, 0);
}

TEST(LineQueue, MakesTheSourceWaitWhileItIsFull) {
  LineQueue queue(1'000);
  std::atomic<int> pushed = 0;
  std::thread source([&] {
    for (int i = 0; i < 50; ++i) {
      if (queue.Push(Line(std::string(100, static_cast<char>('a' + i % 26))))) ++pushed;
    }
    queue.Close();
  });
  ASSERT_TRUE(WaitUntil([&] { return queue.counters().waits == 1; }));
  const int before = pushed;
  EXPECT_GE(before, 5);
  EXPECT_LE(before, 10);
  EXPECT_EQ(queue.counters().waiting_lines, static_cast<std::size_t>(before));
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(PopText(&queue), std::string(100, static_cast<char>('a' + i % 26)));
  }
  EXPECT_EQ(PopText(&queue), "(end)");
  source.join();
  EXPECT_EQ(pushed, 50);
  EXPECT_EQ(queue.counters().bytes, 5'000);
  EXPECT_EQ(queue.counters().waiting_lines, 0U);
}

TEST(LineQueue, ClosingFreesASourceThatWaitsForRoom) {
  LineQueue queue(10);
  queue.Push(Line("first"));
  bool taken = true;
  std::thread source([&] { taken = queue.Push(Line("second")); });
  ASSERT_TRUE(WaitUntil([&] { return queue.counters().waits == 1; }));
  queue.Close();
  source.join();
  EXPECT_FALSE(taken);
  EXPECT_EQ(PopText(&queue), "first");
  EXPECT_EQ(PopText(&queue), "(end)");
}

TEST(LineQueue, ClosingFreesAMapperThatWaitsForLines) {
  LineQueue queue;
  std::thread mapper([&] { EXPECT_EQ(PopText(&queue), "(end)"); });
  queue.Close();
  mapper.join();
}

TEST(LineQueue, ManyLinesOfAnySizePassBetweenTwoThreadsWhole) {
  constexpr int kLines = 20'000;
  const auto text_of = [](PortableRandom* random, int i) {
    return std::to_string(i) + std::string(static_cast<std::size_t>(random->Uniform(0, 300)), '.');
  };
  LineQueue queue(4'000);
  std::thread source([&] {
    PortableRandom random(1);
    for (int i = 0; i < kLines; ++i) queue.Push(Line(text_of(&random, i)));
    queue.Close();
  });
  PortableRandom random(1);
  for (int i = 0; i < kLines; ++i) ASSERT_EQ(PopText(&queue), text_of(&random, i));
  EXPECT_EQ(PopText(&queue), "(end)");
  source.join();
  EXPECT_EQ(queue.counters().lines, kLines);
}

}  // namespace
}  // namespace loopgrid
