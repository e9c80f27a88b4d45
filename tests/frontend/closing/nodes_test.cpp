#include "frontend/closing/nodes.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "tests/frontend/slam/walk.h"

namespace loopgrid {
namespace {

// Nodes along x at the given places, each with one hit a metre ahead.
class NodesOnALine : public ::testing::Test {
 protected:
  NodesOnALine() {
    double last = 0.0;
    for (double x : {0.0, 1.0, 1.5, 3.5, 3.5, 4.0}) {
      PointScan scan;
      scan.hits = {{1.0F, 0.0F}};
      scan.normals = {{-1.0F, 0.0F}};
      walk_.Add(SE2(x - last, 0.0, 0.0), scan);
      last = x;
    }
  }

  const Nodes& nodes() const { return walk_.nodes(); }

 private:
  test_support::Walk walk_;
};

TEST_F(NodesOnALine, PathLengthIsTheSumOfTheSteps) {
  EXPECT_DOUBLE_EQ(nodes().StepLength(2), 2.0);
  EXPECT_DOUBLE_EQ(nodes().StepLength(3), 0.0);
  EXPECT_DOUBLE_EQ(nodes().PathLength(0, 5), 4.0);
  EXPECT_DOUBLE_EQ(nodes().PathLength(5, 1), 3.0);
  EXPECT_DOUBLE_EQ(nodes().PathLength(2, 2), 0.0);
}

TEST_F(NodesOnALine, AroundEndsWhereTheTravelWouldBeTooLong) {
  const auto expect = [&](int node, double path, int first, int last) {
    const NodeRange range = nodes().Around(node, path);
    EXPECT_EQ(range.first, first) << node << ' ' << path;
    EXPECT_EQ(range.last, last) << node << ' ' << path;
  };
  expect(2, 0.0, 2, 2);
  expect(2, 0.5, 1, 2);
  expect(2, 1.9, 0, 2);
  expect(2, 2.0, 0, 4);
  expect(2, 99.0, 0, 5);
  expect(3, 0.0, 3, 4);  // the robot stood still there
  expect(0, 1.0, 0, 1);
  expect(5, 0.5, 3, 5);
}

TEST_F(NodesOnALine, MapHoldsTheScansOfTheRangeInTheFrameOfItsOrigin) {
  const LocalMap map = nodes().MapOf({1, 3}, 2, 10.0);
  ASSERT_EQ(map.surfels().size(), 3U);  // at 2.0, 2.5 and 4.5; seen from 1.5
  for (float x : {0.5F, 1.0F, 3.0F}) {
    EXPECT_NE(map.NearestSurface({x, 0.0F}, {-1.0F, 0.0F}), nullptr) << x;
  }
  EXPECT_EQ(nodes().MapOf({1, 3}, 2, 2.0).surfels().size(), 2U);
  EXPECT_EQ(nodes().MapOf({0, 5}, 0, 10.0).surfels().size(), 5U);  // two in one place
}

TEST_F(NodesOnALine, BetweenIsThePoseOfTheSecondInTheFirst) {
  EXPECT_DOUBLE_EQ(nodes().Between(1, 3).x(), 2.5);
  EXPECT_DOUBLE_EQ(nodes().Between(3, 1).x(), -2.5);
}

TEST(Nodes, AGapIsAsLongAsItIsSaidToBe) {
  test_support::Walk walk;
  for (int i = 0; i < 4; ++i) walk.Add(SE2(1.0, 0.0, 0.0), PointScan());
  Nodes nodes = walk.nodes();
  nodes.gaps[2] = 7.5;  // the robot did not come to node 2 from node 1
  EXPECT_DOUBLE_EQ(nodes.StepLength(1), 7.5);
  EXPECT_DOUBLE_EQ(nodes.StepLength(2), 1.0);
  EXPECT_DOUBLE_EQ(nodes.PathLength(0, 3), 9.5);
  EXPECT_EQ(nodes.Around(3, 5.0).first, 2);
}

TEST(Nodes, MapOfTurnsWithItsOrigin) {
  test_support::Walk walk;
  PointScan scan;
  scan.hits = {{1.0F, 0.0F}};
  scan.normals = {{-1.0F, 0.0F}};
  walk.Add(SE2(5.0, 5.0, 0.5 * std::numbers::pi), scan);
  walk.Add(SE2(1.0, 0.0, -0.5 * std::numbers::pi), scan);  // at (5, 6), looking along x
  const LocalMap map = walk.nodes().MapOf({0, 0}, 1, 10.0);
  EXPECT_NE(map.NearestSurface({0.0F, 0.0F}, {0.0F, -1.0F}), nullptr);
}

}  // namespace
}  // namespace loopgrid
