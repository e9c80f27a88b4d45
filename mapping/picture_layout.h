#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>

#include "mapping/canvas.h"

namespace loopgrid {

// Pixels.
inline constexpr int kMaxPictureSide = 2400;
inline constexpr int kPictureMargin = 24;
inline constexpr int kTextHeight = 18;
/// Of the rows for titles, scale bars and the legend.
inline constexpr int kTextRow = 3 * kTextHeight;
/// Of a panel with a title above, a scale bar and a legend below.
inline constexpr int kMaxPanelHeight = kMaxPictureSide - 3 * kTextRow - 2 * kPictureMargin;
inline constexpr int kMinPanelWidth = 560;  ///< for its title

// Of the map behind a drawing.
inline constexpr Color kFreeColor{228, 228, 228};
inline constexpr Color kWallColor{130, 130, 130};

/// How many pixels wide and high a picture of `extent` is when scaled to fit.
Eigen::Vector2i FittedSize(const Eigen::AlignedBox2d& extent, int max_width, int max_height);

/// Draw a sample of a line, or a dot, and a text beside it that explains it; (left, base) is the
/// lower left corner. Return the left end of the next entry.
int DrawLegendLine(int left, int base, Color color, int thickness, const std::string& text,
                   Canvas* canvas);
int DrawLegendDot(int left, int base, Color color, double radius, const std::string& text,
                  Canvas* canvas);

}  // namespace loopgrid
