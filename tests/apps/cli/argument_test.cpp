#include "apps/cli/argument.h"

#include <gtest/gtest.h>

#include <vector>

namespace loopgrid {
namespace {

TEST(Argument, FieldIsTheNameWithoutDashesUnlessAnotherIsGiven) {
  EXPECT_EQ(FieldOf({.name = "--node-distance"}), "node_distance");
  EXPECT_EQ(FieldOf({.name = "--tolerance", .field = "relative_decrease"}), "relative_decrease");
  EXPECT_EQ(FieldOf({.name = "LOG"}), "LOG");
}

TEST(Argument, MessagesThatBeginWithAFieldNameTheOption) {
  const std::vector<Argument> arguments = {{.name = "--node-distance"},
                                           {.name = "--node-angle"},
                                           {.name = "--tolerance", .field = "relative_decrease"},
                                           {.name = "--loss-width", .field = "robust loss width"}};
  EXPECT_EQ(WithOptionNames("node_distance is -1, expected 0.05 to 10", arguments),
            "--node-distance is -1, expected 0.05 to 10");
  EXPECT_EQ(WithOptionNames("relative_decrease is nan", arguments), "--tolerance is nan");
  EXPECT_EQ(WithOptionNames("robust loss width is 0", arguments), "--loss-width is 0");
}

TEST(Argument, OtherMessagesStayAsTheyAre) {
  const std::vector<Argument> arguments = {{.name = "--node"}};
  for (const char* message :
       {"node_distance is -1", "nodes is 1", "a node is 1", "node: is 1", "", "--node is 1"}) {
    EXPECT_EQ(WithOptionNames(message, arguments), message);
  }
}

}  // namespace
}  // namespace loopgrid
