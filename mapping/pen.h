#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>

#include "mapping/color.h"

namespace loopgrid {

/// A rectangle of a picture in memory: 3 bytes a pixel (red, green, blue), the first row on top.
struct PixelBlock {
  std::uint8_t* first = nullptr;  ///< the top left pixel
  int width = 0;
  int height = 0;
  std::size_t row_bytes = 0;  ///< from a pixel to the one below it
};

/// Draws lines and text into pixels. It is an interface so that a program can load the drawing
/// library when it draws for the first time, and not when it starts.
class Pen {
 public:
  virtual ~Pen() = default;

  /// An anti-aliased line in pixels from the top left corner of the block, cut at its borders. The
  /// coordinates are finite and may be any distance outside.
  virtual void DrawLine(const PixelBlock& block, const Eigen::Vector2d& from,
                        const Eigen::Vector2d& to, Color color, int thickness) const = 0;

  /// One line of ASCII text; (x, y) is the left end of its base line, `height` that of a capital.
  virtual void DrawText(const PixelBlock& block, int x, int y, int height, const std::string& text,
                        Color color) const = 0;

  /// The width of such a text in pixels.
  virtual int TextWidth(int height, const std::string& text) const = 0;
};

/// The pen that draws with OpenCV.
const Pen& OpenCvPen();

/// The pen that Canvas draws with. The library defines this function in drawing_pen.cpp; it returns
/// OpenCvPen(). A program may define the function itself. Its definition is then used, and OpenCV
/// is not linked.
const Pen& DrawingPen();

}  // namespace loopgrid
