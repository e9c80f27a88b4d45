#include "tests/mapping/drawing_testing.h"

#include <cstddef>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "mapping/fitted_map.h"

namespace loopgrid::test_support {

cv::Mat Decode(const std::string& png) {
  return cv::imdecode(std::vector<unsigned char>(png.begin(), png.end()), cv::IMREAD_COLOR);
}

cv::Mat Mask(const cv::Mat& image, Color color) {
  cv::Mat mask;
  const cv::Scalar tolerance(45, 45, 45);
  const cv::Scalar middle(color.blue, color.green, color.red);
  cv::inRange(image, middle - tolerance, middle + tolerance, mask);
  return mask;
}

int Count(const cv::Mat& image, Color color) { return cv::countNonZero(Mask(image, color)); }

std::vector<SE2> SquareDrive(double drift) {
  std::vector<SE2> nodes;
  SE2 pose;
  for (int i = 0; i < 40; ++i) {
    nodes.push_back(pose);
    pose = pose * SE2(1.0, 0.0, (i % 10 == 9 ? 1.5707963 : 0.0) + drift);
  }
  return nodes;
}

OccupancyGrid Backdrop(const std::vector<SE2>& poses) {
  static const std::vector<Eigen::Vector2f> kHits = {{0.0F, 1.0F}, {0.05F, -1.0F}};
  return RenderBackdrop(poses, [](std::size_t) { return MapScan{{0.0, 0.0}, kHits, {}}; });
}

}  // namespace loopgrid::test_support
