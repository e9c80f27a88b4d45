#include "mapping/map_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "backend/base/atomic_file.h"
#include "backend/base/error.h"
#include "mapping/png_encoder.h"

namespace loopgrid {
namespace {

std::uint8_t GreyOf(CellState state) {
  switch (state) {
    case CellState::kWall:
      return kGreyWall;
    case CellState::kFree:
      return kGreyFree;
    case CellState::kUnknown:
      break;
  }
  return kGreyUnknown;
}

// The cells that an image shows: if nothing was seen, the cell at the origin.
CellBox PicturedBox(const CellBox& seen) { return seen.empty() ? CellBox{0, 0, 1, 1} : seen; }

}  // namespace

MapPicture BlankMap(const CellBox& seen) {
  const CellBox box = PicturedBox(seen);
  if (box.width() > kMaxMapSide || box.height() > kMaxMapSide) {
    throw Error(ErrorCode::kUsage,
                fmt::format("a map image of {} x {} pixels is more than {} a side; take a coarser "
                            "resolution",
                            box.width(), box.height(), kMaxMapSide));
  }
  MapPicture picture{.image = {.width = static_cast<int>(box.width()),
                               .height = static_cast<int>(box.height()),
                               .pixels = {}},
                     .box = box};
  picture.image.pixels.resize(static_cast<std::size_t>(box.width() * box.height()), kGreyUnknown);
  return picture;
}

std::vector<std::uint8_t> DrawCells(const OccupancyGrid& grid, const CellBox& box) {
  std::vector<std::uint8_t> cells;
  cells.reserve(static_cast<std::size_t>(box.width() * box.height()));
  for (std::int64_t y = box.min_y; y < box.max_y; ++y) {
    for (std::int64_t x = box.min_x; x < box.max_x; ++x) cells.push_back(GreyOf(grid.State(x, y)));
  }
  return cells;
}

GreyImage DrawMap(const OccupancyGrid& grid) {
  MapPicture picture = BlankMap(grid.SeenBox());
  const CellBox& box = picture.box;
  auto row = picture.image.pixels.begin();
  for (std::int64_t y = box.max_y - 1; y >= box.min_y; --y, row += box.width()) {
    std::ranges::copy(DrawCells(grid, {box.min_x, y, box.max_x, y + 1}), row);
  }
  return std::move(picture.image);
}

std::string EncodePng(const GreyImage& image) {
  return EncodePng(image.width, image.height, PixelFormat::kGrey, image.pixels);
}

std::string EncodePgm(const GreyImage& image) {
  std::string bytes = fmt::format("P5\n{} {}\n255\n", image.width, image.height);
  bytes.append(image.pixels.begin(), image.pixels.end());
  return bytes;
}

std::string MapYaml(const OccupancyGrid& grid, std::string_view image_name) {
  return MapYaml(PicturedBox(grid.SeenBox()), grid.resolution(), image_name);
}

std::string MapYaml(const CellBox& box, double resolution, std::string_view image_name) {
  return fmt::format(
      "image: {}\n"
      "resolution: {}\n"
      "origin: [{:.6f}, {:.6f}, 0.0]\n"
      "negate: 0\n"
      "occupied_thresh: 0.65\n"
      "free_thresh: 0.196\n",
      image_name, resolution, static_cast<double>(box.min_x) * resolution,
      static_cast<double>(box.min_y) * resolution);
}

void WriteMapFiles(const OccupancyGrid& grid, const std::string& folder) {
  const std::filesystem::path path(folder);
  const GreyImage image = DrawMap(grid);
  WriteFileAtomically(path / "map.png", EncodePng(image));
  WriteFileAtomically(path / "map.pgm", EncodePgm(image));
  WriteFileAtomically(path / "map.yaml", MapYaml(grid, "map.pgm"));
}

}  // namespace loopgrid
