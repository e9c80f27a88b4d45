#include "apps/replay/replay_schedule.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace loopgrid {
namespace {

using ::testing::ElementsAre;

std::vector<double> DueTimes(double speed, const std::vector<double>& timestamps) {
  ReplaySchedule schedule(speed);
  std::vector<double> due;
  for (const double timestamp : timestamps) due.push_back(schedule.Due(timestamp));
  return due;
}

TEST(ReplaySchedule, KeepsTheIntervalsOfTheLogFromItsFirstScanOn) {
  EXPECT_THAT(DueTimes(1.0, {1e9, 1e9 + 0.5, 1e9 + 0.5, 1e9 + 5.5}), ElementsAre(0, 0.5, 0.5, 5.5));
  EXPECT_THAT(DueTimes(1.0, {-3.0, -1.0, 1.0}), ElementsAre(0, 2, 4));
}

TEST(ReplaySchedule, ScalesThemWithTheSpeed) {
  EXPECT_THAT(DueTimes(4.0, {10, 11, 13}), ElementsAre(0, 0.25, 0.75));
  EXPECT_THAT(DueTimes(0.5, {10, 11, 13}), ElementsAre(0, 2, 6));
}

TEST(ReplaySchedule, WaitsNeitherForStepsBackwardsNorForLongGaps) {
  EXPECT_THAT(DueTimes(1.0, {10, 11, 3, 4, 9.5, 10, 10 + ReplaySchedule::kLongestGap}),
              ElementsAre(0, 1, 1, 2, 2, 2.5, 2.5 + ReplaySchedule::kLongestGap));
}

TEST(ReplaySchedule, AGapIsLongByTheClockOfTheLogAtAnySpeed) {
  EXPECT_THAT(DueTimes(100.0, {0, 6, 7}), ElementsAre(0, 0, 0.01));
  EXPECT_THAT(DueTimes(0.1, {0, 4, 10}), ElementsAre(0, 40, 40));
}

TEST(ReplaySchedule, AtSpeedZeroAllIsDueAtOnce) {
  EXPECT_THAT(DueTimes(0.0, {0, 1, 2}), ElementsAre(0, 0, 0));
}

}  // namespace
}  // namespace loopgrid
