#include "apps/run/run_arguments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/apps/parse.h"

namespace loopgrid {
namespace {

using test_support::ParseArguments;
using test_support::UsageErrorOf;
using ::testing::HasSubstr;

TEST(RunArguments, TakeALogAndAFolderAndHaveDefaultsForAllElse) {
  RunOptions run;
  ParseArguments(DescribeRun(&run), {"a.clf", "--out", "b"});
  EXPECT_EQ(run.log, "a.clf");
  EXPECT_EQ(run.out, "b");
  EXPECT_EQ(run.resolution, 0.05);
  EXPECT_EQ(run.slam.node_distance, SlamOptions().node_distance);
  EXPECT_EQ(run.slam.node_angle, SlamOptions().node_angle);
  EXPECT_FALSE(run.strict);
  EXPECT_FALSE(run.quiet);
  EXPECT_NO_THROW(run.Validate());
}

TEST(RunArguments, ReachTheirFields) {
  RunOptions run;
  ParseArguments(DescribeRun(&run), {"a.clf", "--out=b", "--resolution", "0.1", "--node-distance",
                                     "0.7", "--node-angle", "0.3", "--strict", "--quiet"});
  EXPECT_EQ(run.resolution, 0.1);
  EXPECT_EQ(run.slam.node_distance, 0.7);
  EXPECT_EQ(run.slam.node_angle, 0.3);
  EXPECT_TRUE(run.strict);
  EXPECT_TRUE(run.quiet);
}

TEST(RunArguments, LogAndFolderMustBeNamed) {
  RunOptions run;
  EXPECT_THAT(UsageErrorOf(DescribeRun(&run), {}), HasSubstr("LOG is required"));
  EXPECT_THAT(UsageErrorOf(DescribeRun(&run), {"a.clf"}), HasSubstr("--out is required"));
  EXPECT_THAT(UsageErrorOf(DescribeRun(&run), {"a.clf", "--out", ""}),
              HasSubstr("--out: the name is empty"));
}

}  // namespace
}  // namespace loopgrid
