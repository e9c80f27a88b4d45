#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "mapping/map_files.h"
#include "mapping/occupancy_grid.h"

namespace loopgrid {

/// Identifies a square of the map with kTileSide pixels a side, where a pixel is 2^level cells
/// wide. Its lower left corner is at cell (x, y) * kTileSide * 2^level, and stays there when the
/// map grows.
struct TileId {
  int level = 0;  ///< 0 (a pixel is a cell) to kTileLevels - 1
  int x = 0;
  int y = 0;

  auto operator<=>(const TileId&) const = default;
};

inline constexpr int kTileSide = 256;
inline constexpr int kTileLevels = 6;

/// A tile and the number of its last change.
struct TileVersion {
  TileId id;
  std::uint64_t version = 0;
};

/// A map as pixels, cut into squares at several scales, so that a viewer fetches only what has
/// changed. On coarser levels a pixel is a wall if any of its cells is a wall, else free if any is
/// free. Takes 1.4 bytes for each cell of the squares in which anything was seen, and the PNG file
/// of each tile that was asked for. All methods may be called from any thread.
class MapTiles {
 public:
  /// Copies the cells of `box`. The version of a tile increases if one of its pixels changes.
  void Update(const OccupancyGrid& grid, const CellBox& box);

  /// The number of changes so far; also the version of the tile that changed last. Starts at 0.
  std::uint64_t version() const;

  /// The tiles with a version above `version`, oldest change first.
  std::vector<TileVersion> ChangedSince(std::uint64_t version) const;

  /// The tile as PNG, 8 bits, grey, first row at the top; null if there is no such tile. Encoded
  /// when asked for. Its version (or a later one) goes to `version` if that is not null.
  std::shared_ptr<const std::string> Png(const TileId& id, std::uint64_t* version = nullptr) const;

  /// The whole map as DrawMap() draws the grid. If that is more than `max_side` pixels a side, a
  /// pixel is a square of 2, 4, 8, ... cells a side, the smallest with which it fits.
  MapPicture Picture(std::int64_t max_side = kMaxMapSide) const;

 private:
  // Row-major, the first row has the smallest y.
  using Pixels = std::array<std::uint8_t, std::size_t{kTileSide} * kTileSide>;

  struct Tile {
    std::unique_ptr<Pixels> pixels;
    std::uint64_t version = 0;
    std::shared_ptr<const std::string> png;  // of this version; null if not encoded yet
  };

  Tile* FindOrAdd(const TileId& id);
  bool TakeCells(const TileId& id, const CellBox& part, const std::vector<std::uint8_t>& cells);
  bool ShrinkInto(const TileId& parent, const TileId& child);
  void UpdateCoarserLevels(std::vector<TileId> changed);
  CellBox SeenBox() const;

  mutable std::mutex mutex_;
  mutable std::map<TileId, Tile> tiles_;
  std::uint64_t version_ = 0;
};

}  // namespace loopgrid
