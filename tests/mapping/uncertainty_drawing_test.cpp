#include "mapping/uncertainty_drawing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "backend/base/error.h"
#include "tests/mapping/drawing_testing.h"

namespace loopgrid {
namespace {

using test_support::Backdrop;
using test_support::Count;
using test_support::Decode;
using test_support::kGreen;
using test_support::kSequential;
using test_support::Mask;
using test_support::SquareDrive;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(DrawUncertainty, TurnsCovariancesFromTheNodesFrameIntoTheMaps) {
  // Two nodes that look along y and are uncertain along their own x axis, so the ellipses are
  // upright.
  const std::vector<SE2> nodes = {SE2(0.0, 0.0, 1.5707963), SE2(20.0, 0.0, 1.5707963)};
  const Eigen::Matrix3d covariance = Eigen::Vector3d(1.0, 0.04, 0.01).asDiagonal();
  const std::vector<Eigen::Matrix3d> covariances = {covariance, Eigen::Matrix3d::Zero()};
  const cv::Mat image = Decode(DrawUncertainty(nodes, covariances));
  // The first node's half of the picture, without the legend.
  std::vector<cv::Point> ink;
  cv::findNonZero(Mask(image(cv::Rect(0, 0, image.cols / 2, image.rows - 80)), kSequential), ink);
  ASSERT_FALSE(ink.empty());
  const cv::Rect box = cv::boundingRect(ink);
  EXPECT_NEAR(static_cast<double>(box.height) / box.width, 5.0, 0.1);
  EXPECT_GT(Count(image, kGreen), 100);
}

TEST(DrawUncertainty, LeavesOutWhatIsNoCovarianceAndCutsWhatIsHuge) {
  const std::vector<SE2> nodes = SquareDrive(0.0);
  std::vector<Eigen::Matrix3d> covariances(nodes.size(), 0.01 * Eigen::Matrix3d::Identity());
  covariances[3](0, 0) = std::numeric_limits<double>::quiet_NaN();
  covariances[4] *= -1.0;
  covariances[5] *= 1e300;
  covariances[6](1, 1) = std::numeric_limits<double>::infinity();
  const OccupancyGrid map = Backdrop(nodes);
  const cv::Mat image = Decode(DrawUncertainty(nodes, covariances, &map));
  EXPECT_LE(std::max(image.cols, image.rows), 2400);
  EXPECT_GT(Count(image, kSequential), 1000);
}

TEST(DrawUncertainty, WantsOneCovarianceANode) {
  const std::vector<SE2> nodes = SquareDrive(0.0);
  EXPECT_THAT([&] { DrawUncertainty(nodes, {}); },
              ThrowsMessage<Error>(HasSubstr("0 covariances for 40 nodes")));
}

}  // namespace
}  // namespace loopgrid
