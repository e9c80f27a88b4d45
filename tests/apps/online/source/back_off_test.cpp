#include "apps/online/source/back_off.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace loopgrid {
namespace {

using ::testing::ElementsAre;

std::vector<double> Pauses(BackOff* back_off, int count) {
  std::vector<double> pauses;
  for (int i = 0; i < count; ++i) pauses.push_back(back_off->Next());
  return pauses;
}

TEST(BackOff, DoublesUpToTheLongestAndBeginsAnewOnceItHasWorked) {
  BackOff back_off(0.5, 10.0);
  EXPECT_THAT(Pauses(&back_off, 7), ElementsAre(0.5, 1.0, 2.0, 4.0, 8.0, 10.0, 10.0));
  back_off.Reset();
  EXPECT_THAT(Pauses(&back_off, 2), ElementsAre(0.5, 1.0));
}

TEST(BackOff, NeverExceedsTheLongest) {
  BackOff back_off(3.0, 2.0);
  EXPECT_THAT(Pauses(&back_off, 3), ElementsAre(2.0, 2.0, 2.0));
}

}  // namespace
}  // namespace loopgrid
