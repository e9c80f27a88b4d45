#include "apps/online/source/shared_counters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace loopgrid {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(SharedCounters, GiveEachProblemOnceUntilTheSourceRecovers) {
  SharedCounters counters;
  for (int i = 0; i < 3; ++i) {
    counters.Note("a");
    counters.Note("b");
  }
  EXPECT_THAT(counters.TakeNotices(), ElementsAre("a", "b"));
  counters.Note("a");
  EXPECT_THAT(counters.TakeNotices(), IsEmpty());
  EXPECT_EQ(counters.Snapshot().last_problem, "a");
  counters.Recover();
  counters.Note("a");
  EXPECT_THAT(counters.TakeNotices(), ElementsAre("a"));
}

TEST(SharedCounters, HoldAFewNoticesThatNobodyTakes) {
  SharedCounters counters;
  for (int i = 0; i < 1000; ++i) counters.Note(std::to_string(i));
  EXPECT_EQ(counters.TakeNotices().size(), 100u);
  counters.Note("another");
  EXPECT_THAT(counters.TakeNotices(), ElementsAre("another"));
}

}  // namespace
}  // namespace loopgrid
