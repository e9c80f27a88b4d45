#include "apps/eval/eval_arguments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/apps/parse.h"

namespace loopgrid {
namespace {

using test_support::ParseArguments;
using test_support::UsageErrorOf;
using ::testing::HasSubstr;

TEST(EvalArguments, TakeTwoFiles) {
  EvalOptions eval;
  const Command command = DescribeEval(&eval);
  ParseArguments(command, {"a.tum", "b.relations"});
  EXPECT_EQ(eval.estimate, "a.tum");
  EXPECT_EQ(eval.reference, "b.relations");
  EXPECT_FALSE(eval.json);
  ParseArguments(command, {"a.tum", "b.relations", "--json"});
  EXPECT_TRUE(eval.json);
  EXPECT_THAT(UsageErrorOf(command, {"a.tum"}), HasSubstr("REFERENCE is required"));
  EXPECT_THAT(UsageErrorOf(command, {"a.tum", "b.tum", "c.tum"}), HasSubstr("c.tum"));
}

}  // namespace
}  // namespace loopgrid
