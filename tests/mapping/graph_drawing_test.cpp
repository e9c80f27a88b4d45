#include "mapping/graph_drawing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const cv::Vec3b kSequential(190, 100, 30);  // OpenCV's order: blue, green, red
const cv::Vec3b kClosure(35, 75, 225);
const cv::Vec3b kRobot(60, 140, 20);
const cv::Vec3b kWall(130, 130, 130);

cv::Mat Decode(const std::string& png) {
  return cv::imdecode(std::vector<unsigned char>(png.begin(), png.end()), cv::IMREAD_COLOR);
}

// Where the colour is, give or take what anti-aliasing leaves of it on thin lines.
cv::Mat Mask(const cv::Mat& image, const cv::Vec3b& color) {
  cv::Mat mask;
  const cv::Scalar tolerance(45, 45, 45);
  cv::inRange(image, cv::Scalar(color) - tolerance, cv::Scalar(color) + tolerance, mask);
  return mask;
}

int Count(const cv::Mat& image, const cv::Vec3b& color) {
  return cv::countNonZero(Mask(image, color));
}

// A square drive of 40 nodes, 10 m a side.
std::vector<SE2> SquareDrive(double drift) {
  std::vector<SE2> nodes;
  SE2 pose;
  for (int i = 0; i < 40; ++i) {
    nodes.push_back(pose);
    pose = pose * SE2(1.0, 0.0, (i % 10 == 9 ? 1.5707963 : 0.0) + drift);
  }
  return nodes;
}

std::vector<GraphEdge> SquareEdges() {
  std::vector<GraphEdge> edges;
  for (int i = 1; i < 40; ++i) edges.push_back({i - 1, i, EdgeKind::kSequential});
  edges.push_back({3, 26, EdgeKind::kClosure});
  return edges;
}

// Each scan sees a wall a metre to either side.
OccupancyGrid Backdrop(const std::vector<SE2>& poses) {
  static const std::vector<Eigen::Vector2f> kHits = {{0.0F, 1.0F}, {0.05F, -1.0F}};
  return RenderBackdrop(poses, [](std::size_t) { return MapScan{{0.0, 0.0}, kHits, {}}; });
}

TEST(DrawGraphBeforeAfter, ShowsMapAndBothKindsOfConstraint) {
  const std::vector<SE2> before = SquareDrive(0.02);
  const std::vector<SE2> after = SquareDrive(0.0);
  const OccupancyGrid map_before = Backdrop(before);
  const OccupancyGrid map_after = Backdrop(after);
  const std::string png =
      DrawGraphBeforeAfter({before, &map_before}, {after, &map_after}, SquareEdges());
  const cv::Mat image = Decode(png);
  EXPECT_LE(std::max(image.cols, image.rows), 2400);
  EXPECT_GE(std::max(image.cols, image.rows), 2000);
  for (const cv::Mat& half :
       {image.colRange(0, image.cols / 2), image.colRange(image.cols / 2, image.cols)}) {
    const cv::Mat map = half.rowRange(0, half.rows - 80);  // without the legend
    EXPECT_GT(Count(map, kSequential), 3000);
    EXPECT_GT(Count(map, kClosure), 30);
    EXPECT_GT(Count(map, kWall), 1000);
  }
  EXPECT_EQ(png, DrawGraphBeforeAfter({before, &map_before}, {after, &map_after}, SquareEdges()));
}

TEST(DrawGraphBeforeAfter, IsOfSensibleSizeWhateverTheExtent) {
  for (const auto& [dx, dy] : std::vector<std::pair<double, double>>{
           {0.0, 0.0}, {1e-3, 0.0}, {0.0, 5.0}, {1e5, 1.0}, {1e9, 1e9}, {0.0, 1e200}}) {
    const std::vector<SE2> nodes = {SE2(), SE2(dx, dy, 0.0)};
    const std::vector<GraphEdge> edges = {{0, 1, EdgeKind::kSequential}};
    const cv::Mat image = Decode(DrawGraphBeforeAfter({nodes}, {nodes}, edges));
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
  EXPECT_THAT([&] { DrawGraphBeforeAfter({nodes}, {nodes}, edges); },
              ThrowsMessage<Error>(HasSubstr("edge 0 - 2: the graph has 2 nodes")));
  EXPECT_THAT([&] { DrawGraphBeforeAfter({nodes}, {bad}, {}); },
              ThrowsMessage<Error>(HasSubstr("node 1 is not finite")));
}

TEST(DrawUncertainty, TurnsCovariancesFromTheNodesFrameIntoTheMaps) {
  // Two nodes that look along y and know little along their own x axis: upright ellipses.
  const std::vector<SE2> nodes = {SE2(0.0, 0.0, 1.5707963), SE2(20.0, 0.0, 1.5707963)};
  const Eigen::Matrix3d covariance = Eigen::Vector3d(1.0, 0.04, 0.01).asDiagonal();
  const std::vector<Eigen::Matrix3d> covariances = {covariance, Eigen::Matrix3d::Zero()};
  const cv::Mat image = Decode(DrawUncertainty({nodes}, covariances));
  // The first node's half of the picture, without the legend.
  std::vector<cv::Point> ink;
  cv::findNonZero(Mask(image(cv::Rect(0, 0, image.cols / 2, image.rows - 80)), kSequential), ink);
  ASSERT_FALSE(ink.empty());
  const cv::Rect box = cv::boundingRect(ink);
  EXPECT_NEAR(static_cast<double>(box.height) / box.width, 5.0, 0.1);
  EXPECT_GT(Count(image, kRobot), 100);
}

TEST(DrawUncertainty, LeavesOutWhatIsNoCovarianceAndCutsWhatIsHuge) {
  const std::vector<SE2> nodes = SquareDrive(0.0);
  std::vector<Eigen::Matrix3d> covariances(nodes.size(), 0.01 * Eigen::Matrix3d::Identity());
  covariances[3](0, 0) = std::numeric_limits<double>::quiet_NaN();
  covariances[4] *= -1.0;
  covariances[5] *= 1e300;
  covariances[6](1, 1) = std::numeric_limits<double>::infinity();
  const OccupancyGrid map = Backdrop(nodes);
  const cv::Mat image = Decode(DrawUncertainty({nodes, &map}, covariances));
  EXPECT_LE(std::max(image.cols, image.rows), 2400);
  EXPECT_GT(Count(image, kSequential), 1000);
}

TEST(DrawUncertainty, WantsOneCovarianceANode) {
  const std::vector<SE2> nodes = SquareDrive(0.0);
  EXPECT_THAT([&] { DrawUncertainty({nodes}, {}); },
              ThrowsMessage<Error>(HasSubstr("0 covariances for 40 nodes")));
}

TEST(RenderBackdrop, KeepsToAFewCellsHoweverLargeTheMap) {
  std::vector<SE2> poses = {SE2(), SE2(5000.0, 3000.0, 0.0)};
  const OccupancyGrid large = Backdrop(poses);
  EXPECT_LE(large.SeenBox().width(), 1202);
  poses.pop_back();
  EXPECT_EQ(Backdrop(poses).resolution(), OccupancyGridOptions().resolution);
}

}  // namespace
}  // namespace loopgrid
