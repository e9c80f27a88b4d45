#include "apps/cli/progress_bar.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace loopgrid {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(FormatProgress, TellsShareCountRateAndTimeLeft) {
  EXPECT_EQ(FormatProgress(0.25, 500, 10.0, 79),
            "[#######                       ]  25 %  500 scans, 50/s, 30 s left");
}

TEST(FormatProgress, LongTimesAreInMinutesAndHours) {
  EXPECT_THAT(FormatProgress(0.5, 1, 61.0, 200), EndsWith("1 min 01 s left"));
  EXPECT_THAT(FormatProgress(0.5, 1, 3661.0, 200), EndsWith("1 h 01 min left"));
}

TEST(FormatProgress, MakesNoPromiseInTheFirstMoment) {
  EXPECT_EQ(FormatProgress(0.5, 10, 0.1, 20), " 50 %  10 scans");
}

TEST(FormatProgress, WithoutKnownSizeThereIsNoBarAndNoPromise) {
  EXPECT_EQ(FormatProgress(0.0, 500, 10.0, 79), "500 scans, 50/s");
}

TEST(FormatProgress, BarIsEmptyAtFirstAndFullAtTheEnd) {
  EXPECT_THAT(FormatProgress(1e-6, 0, 0.0, 79), HasSubstr("[" + std::string(30, ' ') + "]   0 %"));
  EXPECT_THAT(FormatProgress(1.0, 9, 1.0, 79), StartsWith("[" + std::string(30, '#') + "] 100 %"));
  EXPECT_THAT(FormatProgress(1.5, 9, 1.0, 79), StartsWith("[" + std::string(30, '#') + "] 100 %"));
}

TEST(FormatProgress, NeverIsWiderThanTheTerminal) {
  for (int width = 0; width < 120; ++width) {
    for (double fraction : {0.0, 1e-9, 0.3, 1.0}) {
      const std::string line = FormatProgress(fraction, 123456789, 1234.5, width);
      EXPECT_LE(line.size(), static_cast<size_t>(width)) << line;
    }
  }
}

}  // namespace
}  // namespace loopgrid
