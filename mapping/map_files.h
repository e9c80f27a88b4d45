#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/occupancy_grid.h"

namespace loopgrid {

/// Grey values of maps. ROS's map_server computes p = (255 - value) / 255 and compares it with the
/// thresholds of MapYaml: wall if p > 0.65, free if p < 0.196, else unknown.
inline constexpr std::uint8_t kGreyWall = 0;
inline constexpr std::uint8_t kGreyUnknown = 205;
inline constexpr std::uint8_t kGreyFree = 254;

/// A map image has at most this many pixels a side, because common programs cannot open larger
/// ones.
inline constexpr std::int64_t kMaxMapSide = 32767;

/// A grey picture: row-major, the first row is the top.
struct GreyImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
};

/// A picture of a map, y upwards. A pixel is one cell, or the square of `cells_per_pixel` cells a
/// side that begins at a multiple of that number.
struct MapPicture {
  GreyImage image;
  CellBox box;  ///< what it shows, in pixels: multiply by `cells_per_pixel` for cells
  int cells_per_pixel = 1;
};

/// An unknown map that shows `seen`, or the cell at the origin if that is empty. Throws Error
/// (kUsage) above kMaxMapSide pixels a side.
MapPicture BlankMap(const CellBox& seen);

/// The grey values of the cells of `box`, row-major, the first row has the smallest y.
std::vector<std::uint8_t> DrawCells(const OccupancyGrid& grid, const CellBox& box);

/// The grid cropped to what was seen; one pixel a cell, y upwards. A grid that has seen nothing
/// gives one unknown pixel. Throws Error (kUsage) as BlankMap.
GreyImage DrawMap(const OccupancyGrid& grid);

/// The bytes of map.png and map.pgm: 8 bits, grey. The same image gives the same bytes.
std::string EncodePng(const GreyImage& image);
std::string EncodePgm(const GreyImage& image);

/// The text of map.yaml in the convention of ROS's map_server: `origin` is the lower left corner of
/// the image in the map frame (metres, metres, radians).
std::string MapYaml(const OccupancyGrid& grid, std::string_view image_name);

/// The same for a picture of the cells in `box`; `resolution` in metres.
std::string MapYaml(const CellBox& box, double resolution, std::string_view image_name);

/// Writes map.png, map.pgm and map.yaml into a folder that exists, each whole or not at all. Throws
/// Error: kOutput if one cannot be written, kUsage as DrawMap.
void WriteMapFiles(const OccupancyGrid& grid, const std::string& folder);

}  // namespace loopgrid
