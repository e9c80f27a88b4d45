#include "apps/online/online_arguments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "apps/view/view_argument.h"
#include "tests/apps/parse.h"

namespace loopgrid {
namespace {

OnlineOptions ParseOnline(const std::vector<const char*>& words) {
  OnlineOptions online;
  test_support::ParseArguments(DescribeOnline(&online, DescribeView()), words);
  return online;
}

TEST(OnlineArguments, TakeAFolderAndHaveDefaultsForAllElse) {
  const OnlineOptions online = ParseOnline({"--out", "a"});
  EXPECT_EQ(online.run.out, "a");
  for (const std::string* option : {&online.follow, &online.listen, &online.connect, &online.resume,
                                    &online.continued, &online.view, &online.events}) {
    EXPECT_EQ(*option, "");
  }
  EXPECT_FALSE(online.once || online.run.strict || online.run.quiet);
  EXPECT_EQ(online.interval, 5.0);
  EXPECT_EQ(online.threads, 2);
  EXPECT_TRUE(online.given.empty());
  EXPECT_NO_THROW(online.Validate());
}

TEST(OnlineArguments, ReachTheirFields) {
  const OnlineOptions online = ParseOnline(
      {"--listen", "h:1",          "--once", "--out",        "a",      "--continue",
       "b",        "--view",       "8080",   "--events",     "-",      "--interval",
       "2",        "--threads",    "1",      "--resolution", "0.1",    "--node-distance",
       "0.7",      "--node-angle", "0.3",    "--strict",     "--quiet"});
  EXPECT_EQ(online.listen, "h:1");
  EXPECT_TRUE(online.once && online.run.strict && online.run.quiet);
  EXPECT_EQ(online.run.out, "a");
  EXPECT_EQ(online.continued, "b");
  EXPECT_EQ(online.view, "8080");
  EXPECT_EQ(online.events, "-");
  EXPECT_EQ(online.interval, 2.0);
  EXPECT_EQ(online.threads, 1);
  EXPECT_EQ(online.run.resolution, 0.1);
  EXPECT_EQ(online.run.slam.node_distance, 0.7);
  EXPECT_EQ(online.run.slam.node_angle, 0.3);
  EXPECT_THAT(online.given, ::testing::UnorderedElementsAre("resolution", "node_distance",
                                                            "node_angle", "strict"));
  EXPECT_EQ(ParseOnline({"--follow", "f", "--out", "a"}).follow, "f");
  EXPECT_EQ(ParseOnline({"--connect", "c:2", "--out", "a"}).connect, "c:2");
  EXPECT_EQ(ParseOnline({"--resume", "r"}).resume, "r");
}

}  // namespace
}  // namespace loopgrid
