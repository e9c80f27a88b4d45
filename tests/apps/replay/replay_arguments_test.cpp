#include "apps/replay/replay_arguments.h"

#include <gtest/gtest.h>

#include "tests/apps/parse.h"

namespace loopgrid {
namespace {

using test_support::ParseArguments;

TEST(ReplayArguments, TakeALogAndHaveDefaultsForAllElse) {
  ReplayOptions replay;
  ParseArguments(DescribeReplay(&replay), {"a.clf"});
  EXPECT_EQ(replay.log, "a.clf");
  EXPECT_EQ(replay.speed, 1.0);
  EXPECT_EQ(replay.to, "");
  EXPECT_EQ(replay.loop, 1);
  EXPECT_EQ(replay.from_line, 1);
}

TEST(ReplayArguments, ReachTheirFields) {
  ReplayOptions replay;
  ParseArguments(DescribeReplay(&replay), {"a.clf", "--speed", "10", "--to", "robot:7070", "--loop",
                                           "0", "--from-line", "20"});
  EXPECT_EQ(replay.speed, 10.0);
  EXPECT_EQ(replay.to, "robot:7070");
  EXPECT_EQ(replay.loop, 0);
  EXPECT_EQ(replay.from_line, 20);
}

}  // namespace
}  // namespace loopgrid
