#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "mapping/canvas.h"
#include "mapping/occupancy_grid.h"

namespace loopgrid {

/// The part of the map frame that a grid has seen, metres; empty if nothing.
Eigen::AlignedBox2d SeenExtent(const OccupancyGrid& grid);

/// An area of a canvas that shows a part of the map frame, y upwards, centred and as large as fits.
/// Nothing is drawn outside the area. Coordinates and covariances are those of the map frame.
class MapView {
 public:
  /// An extent that is empty or a single point is widened to a square metre.
  MapView(Canvas* canvas, const PixelArea& area, const Eigen::AlignedBox2d& extent);

  double pixels_per_metre() const { return scale_; }

  /// Where a point is on the canvas, pixels.
  Eigen::Vector2d ToPixel(const Eigen::Vector2d& p_map) const;

  /// Paints what the grid knows: a pixel is a wall if any of the cells it covers is one, else free
  /// if any of them is. Unknown pixels are left as they are.
  void DrawGrid(const OccupancyGrid& grid, Color free, Color wall);

  void DrawLine(const Eigen::Vector2d& from, const Eigen::Vector2d& to, Color color, int thickness);

  void DrawFineLine(const Eigen::Vector2d& from, const Eigen::Vector2d& to, Color color,
                    double opacity);

  void DrawDot(const Eigen::Vector2d& centre, double radius_pixels, Color color);

  /// The ellipse (p - mean)^T covariance^-1 (p - mean) = sigmas^2; a segment if the covariance is
  /// singular. Returns false, and draws nothing, if it is not positive semi-definite or not finite.
  bool DrawEllipse(const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance, double sigmas,
                   Color color, int thickness);

  /// A bar of 1, 2 or 5 times a power of ten metres, about a quarter of the area wide, with its
  /// length written beside it; (left, base) is its lower left corner on the canvas.
  void DrawScaleBar(int left, int base, int text_height);

 private:
  Canvas* canvas_;
  PixelArea area_;
  double scale_;              // pixels per metre
  Eigen::Vector2d top_left_;  // of the area, map frame
};

}  // namespace loopgrid
