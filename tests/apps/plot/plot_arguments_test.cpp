#include "apps/plot/plot_arguments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/apps/parse.h"

namespace loopgrid {
namespace {

using test_support::ParseArguments;
using ::testing::ElementsAre;

TEST(PlotArguments, TakeTracesAndAPicture) {
  PlotOptions plot;
  const Command command = DescribePlot(&plot);
  ParseArguments(command, {"a.csv", "b.csv", "c.csv", "--out", "all.png"});
  EXPECT_THAT(plot.traces, ElementsAre("a.csv", "b.csv", "c.csv"));
  EXPECT_EQ(plot.out, "all.png");
  ParseArguments(command, {"--out", "b.png", "a.csv"});
  EXPECT_THAT(plot.traces, ElementsAre("a.csv"));
}

}  // namespace
}  // namespace loopgrid
