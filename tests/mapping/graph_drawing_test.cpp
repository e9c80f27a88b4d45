#include "mapping/graph_drawing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

#include "backend/base/error.h"
#include "tests/mapping/drawing_testing.h"

namespace loopgrid {
namespace {

using test_support::Backdrop;
using test_support::Count;
using test_support::Decode;
using test_support::kClosure;
using test_support::kGreen;
using test_support::kSequential;
using test_support::kWall;
using test_support::SquareDrive;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr int kLegendHeight = 80;  // a little more

GraphState StateOf(const std::vector<SE2>& nodes, const OccupancyGrid* backdrop = nullptr) {
  GraphState state;
  for (const SE2& node : nodes) state.nodes.emplace_back(node.x(), node.y(), 0.0);
  state.backdrop = backdrop;
  return state;
}

std::vector<GraphEdge> SquareEdges() {
  std::vector<GraphEdge> edges;
  for (int i = 1; i < 40; ++i) edges.push_back({i - 1, i, EdgeKind::kSequential});
  edges.push_back({3, 26, EdgeKind::kClosure});
  return edges;
}

TEST(DrawGraphBeforeAfter, ShowsMapAndBothKindsOfConstraint) {
  const std::vector<SE2> before = SquareDrive(0.02);
  const std::vector<SE2> after = SquareDrive(0.0);
  const OccupancyGrid map_before = Backdrop(before);
  const OccupancyGrid map_after = Backdrop(after);
  const std::string png =
      DrawGraphBeforeAfter(StateOf(before, &map_before), StateOf(after, &map_after), SquareEdges());
  const cv::Mat image = Decode(png);
  EXPECT_LE(std::max(image.cols, image.rows), 2400);
  EXPECT_GE(std::max(image.cols, image.rows), 2000);
  for (const cv::Mat& half :
       {image.colRange(0, image.cols / 2), image.colRange(image.cols / 2, image.cols)}) {
    const cv::Mat map = half.rowRange(0, half.rows - kLegendHeight);
    EXPECT_GT(Count(map, kSequential), 3000);
    EXPECT_GT(Count(map, kClosure), 30);
    EXPECT_GT(Count(map, kWall), 1000);
  }
  EXPECT_EQ(png, DrawGraphBeforeAfter(StateOf(before, &map_before), StateOf(after, &map_after),
                                      SquareEdges()));
}

TEST(DrawGraphBeforeAfter, IsOfSensibleSizeWhateverTheExtent) {
  for (const auto& [dx, dy] : std::vector<std::pair<double, double>>{
           {0.0, 0.0}, {1e-3, 0.0}, {0.0, 5.0}, {1e5, 1.0}, {1e9, 1e9}, {0.0, 1e200}}) {
    const std::vector<SE2> nodes = {SE2(), SE2(dx, dy, 0.0)};
    const std::vector<GraphEdge> edges = {{0, 1, EdgeKind::kSequential}};
    const cv::Mat image = Decode(DrawGraphBeforeAfter(StateOf(nodes), StateOf(nodes), edges));
    EXPECT_LE(std::max(image.cols, image.rows), 2400) << dx << ", " << dy;
    EXPECT_GE(image.cols, 1000) << dx << ", " << dy;
  }
}

TEST(DrawGraphBeforeAfter, DrawsAGraphWithoutNodes) {
  EXPECT_FALSE(Decode(DrawGraphBeforeAfter({}, {}, {})).empty());
}

TEST(DrawGraphBeforeAfter, RefusesEdgesAndPosesThatAreNotThere) {
  const std::vector<SE2> nodes = {SE2(), SE2(1.0, 0.0, 0.0)};
  const std::vector<SE2> bad = {SE2(), SE2(std::numeric_limits<double>::infinity(), 0.0, 0.0)};
  const std::vector<GraphEdge> edges = {{0, 2, EdgeKind::kClosure}};
  EXPECT_THAT([&] { DrawGraphBeforeAfter(StateOf(nodes), StateOf(nodes), edges); },
              ThrowsMessage<Error>(HasSubstr("edge 0 - 2: the graph has 2 nodes")));
  EXPECT_THAT([&] { DrawGraphBeforeAfter(StateOf(nodes), StateOf(bad), {}); },
              ThrowsMessage<Error>(HasSubstr("node 1 is not finite")));
}

TEST(DrawGraphBeforeAfter, ShowsLandmarksAsDots) {
  GraphState state = StateOf(SquareDrive(0.0));
  EXPECT_EQ(Count(Decode(DrawGraphBeforeAfter(state, state, SquareEdges())), kGreen), 0);
  state.landmarks = {{5.0, 5.0, 0.0}, {2.0, 7.0, 0.0}};
  const cv::Mat image = Decode(DrawGraphBeforeAfter(state, state, SquareEdges()));
  EXPECT_GT(Count(image.rowRange(0, image.rows - kLegendHeight), kGreen), 4 * 30);
  // Dots at the border of the picture are complete too.
  GraphState corners = state;
  corners.landmarks = {{-5.0, -5.0, 0.0}, {15.0, 15.0, 0.0}};
  EXPECT_NEAR(Count(Decode(DrawGraphBeforeAfter(corners, corners, SquareEdges())), kGreen),
              Count(image, kGreen), 20);
  state.landmarks[1].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { DrawGraphBeforeAfter(state, state, {}); },
              ThrowsMessage<Error>(HasSubstr("landmark 1 is not finite")));
}

TEST(DrawGraphBeforeAfter, LeavesPaperBetweenTheLinesOfALargeGraph) {
  constexpr int kNodes = 2000;
  GraphState state;
  std::vector<GraphEdge> edges;
  for (int i = 0; i < kNodes; ++i) {
    const double angle = i * 2.4;
    const double radius = std::sqrt(1.0 * i);
    state.nodes.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
    edges.push_back({i, (i * 7 + 13) % kNodes, EdgeKind::kClosure});
  }
  const cv::Mat image = Decode(DrawGraphBeforeAfter(state, state, edges));
  const cv::Mat middle =
      image(cv::Rect(image.cols / 8, image.rows / 4, image.cols / 4, image.rows / 2));
  const cv::Scalar mean = cv::mean(middle);
  EXPECT_GT(mean[0], 100.0);  // of blue, which is 35 in the ink and 255 in the paper
  EXPECT_LT(mean[0], 240.0);
}

TEST(DrawGraphBeforeAfter, ShowsWhatIsFartherAwayPaler) {
  // Two poles. In the oblique view one is behind the other, and so higher in the picture.
  GraphState state;
  state.nodes = {{3.0, -4.0, 0.0}, {3.0, -4.0, 1.0}, {-3.0, 4.0, 0.0}, {-3.0, 4.0, 1.0}};
  const std::vector<GraphEdge> edges = {{0, 1}, {2, 3}};
  const cv::Mat image = Decode(DrawGraphBeforeAfter(state, state, edges, Viewpoint::kOblique));
  const cv::Mat panels = image.rowRange(kLegendHeight, image.rows - 3 * kLegendHeight);
  const cv::Mat upper = panels.rowRange(0, panels.rows / 2);
  const cv::Mat lower = panels.rowRange(panels.rows / 2, panels.rows);
  EXPECT_GT(Count(lower, kSequential), 50);
  EXPECT_EQ(Count(upper, kSequential), 0);
  EXPECT_GT(cv::countNonZero(upper.reshape(1) != 255), 50);
}

TEST(DrawGraphBeforeAfter, ShowsTheThirdDimensionUpwards) {
  GraphState upright;
  upright.nodes = {{0.0, 0.0, 0.0}, {0.0, 0.0, 10.0}};
  const std::vector<GraphEdge> edges = {{0, 1}};
  const cv::Mat image = Decode(DrawGraphBeforeAfter(upright, upright, edges, Viewpoint::kOblique));
  EXPECT_GT(image.rows, image.cols);  // two tall panels
  const cv::Mat above = Decode(DrawGraphBeforeAfter(upright, upright, edges));
  EXPECT_LT(above.rows, above.cols);  // a point
}

}  // namespace
}  // namespace loopgrid
