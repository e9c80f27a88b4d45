#pragma once

#include <string>
#include <vector>

#include "backend/geometry/se2.h"
#include "mapping/canvas.h"
#include "mapping/occupancy_grid.h"

namespace cv {
class Mat;
}

namespace loopgrid::test_support {

inline constexpr Color kSequential{30, 100, 190};
inline constexpr Color kClosure{225, 75, 35};
inline constexpr Color kGreen{20, 140, 60};  // of landmarks, and of the robot's last pose
inline constexpr Color kWall{130, 130, 130};

/// The picture in a PNG.
cv::Mat Decode(const std::string& png);

/// The pixels of this colour, or of what anti-aliasing makes of it on thin lines.
cv::Mat Mask(const cv::Mat& image, Color color);

/// Number of pixels of this colour.
int Count(const cv::Mat& image, Color color);

/// A square drive of 40 nodes, 10 m a side.
std::vector<SE2> SquareDrive(double drift);

/// The map of these poses, if each sees a wall a metre away on both sides.
OccupancyGrid Backdrop(const std::vector<SE2>& poses);

}  // namespace loopgrid::test_support
