#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "mapping/color.h"
#include "mapping/pen.h"

namespace loopgrid {

/// A rectangle of pixels.
struct PixelArea {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
};

/// A colour picture in memory, white to begin with; needs no display. Coordinates are pixels from
/// the top left corner of the picture: pixel (i, j) covers [i, i + 1) x [j, j + 1).
class Canvas {
 public:
  Canvas(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  Color At(int x, int y) const;
  void SetPixel(int x, int y, Color color);

  /// Draws an anti-aliased line, cut at the borders of `area`. Its ends may be any distance
  /// outside. A line with a coordinate that is not finite is left out.
  void DrawLine(const PixelArea& area, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                Color color, int thickness);

  /// Draws a line one pixel wide and mixes its colour with the colour of the picture: `opacity` is
  /// the share of the line's colour, 0..1. Lines of opacity 1/2 look half a pixel wide.
  void DrawFineLine(const PixelArea& area, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                    Color color, double opacity);

  void FillRectangle(const PixelArea& area, Color color);

  /// One line of ASCII text; (x, y) is the left end of its base line, `height` that of a capital.
  void DrawText(int x, int y, int height, const std::string& text, Color color);

  static int TextWidth(int height, const std::string& text);

  /// The bytes of the picture as a PNG file.
  std::string EncodePng() const;

 private:
  const std::uint8_t* PixelAt(int x, int y) const;
  std::uint8_t* PixelAt(int x, int y);
  PixelBlock Block(const PixelArea& area);

  int width_;
  int height_;
  std::vector<std::uint8_t> pixels_;  // red, green, blue; row-major, the first row is the top
};

}  // namespace loopgrid
