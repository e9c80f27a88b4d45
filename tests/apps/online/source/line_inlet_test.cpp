#include "apps/online/source/line_inlet.h"

#include <gtest/gtest.h>

#include <chrono>

namespace loopgrid {
namespace {

TEST(LineInlet, StampsLinesWithTheTimeTheirEndCame) {
  LineQueue queue;
  ReceivedLine line;
  LineInlet inlet(&queue);
  EXPECT_TRUE(inlet.Add("be"));
  EXPECT_FALSE(inlet.completed_line());
  const auto before = std::chrono::steady_clock::now();
  EXPECT_TRUE(inlet.Add("gun\n"));
  EXPECT_TRUE(inlet.completed_line());
  const auto after = std::chrono::steady_clock::now();
  ASSERT_TRUE(queue.Pop(&line));
  EXPECT_EQ(line.text, "begun");
  EXPECT_GE(line.arrival, before);
  EXPECT_LE(line.arrival, after);
}

TEST(LineInlet, TellsWhenTheQueueIsClosedAndClosesItItself) {
  LineQueue queue;
  {
    LineInlet inlet(&queue);
    EXPECT_TRUE(inlet.Add("a\nb"));
    EXPECT_TRUE(inlet.Finish());
    EXPECT_TRUE(inlet.Finish());
  }
  LineInlet late(&queue);
  EXPECT_FALSE(late.Add("c\n"));
  EXPECT_TRUE(late.Add("d"));
  EXPECT_FALSE(late.Finish());
  EXPECT_EQ(queue.counters().lines, 2);
}

}  // namespace
}  // namespace loopgrid
