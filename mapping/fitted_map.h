#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "backend/geometry/se2.h"
#include "mapping/map_files.h"
#include "mapping/occupancy_grid.h"

namespace loopgrid {

/// How large a map and its cells may become before scans are left out.
struct MapLimits {
  std::int64_t max_side = kMaxMapSide;  ///< cells a side
  double coarsest = 1.0;                ///< side of a cell, metres
};

/// A map of all scans that fit on one.
struct FittedMap {
  OccupancyGrid grid;
  std::vector<std::size_t> left_out;  ///< indices of the scans that are not on it, ascending
};

/// Draws a map as RenderMap does, for scans at any places. If the map would have more than
/// `options.max_cells` cells, or more than `limits.max_side` a side, its cells become larger:
/// `options.resolution` times the smallest whole number that makes the map fit. Scans far from the
/// others are left out if a hundredth of all scans (or one scan) would make the cells more than
/// twice as large, or if the map does not fit with cells of `limits.coarsest`. Scans without a
/// place (not finite, or beyond the largest cell index) are always left out. Throws Error (kUsage)
/// if the options are not valid or allow no map at all.
FittedMap RenderFittedMap(std::span<const SE2> poses,
                          const std::function<MapScan(std::size_t)>& scan_at,
                          const OccupancyGridOptions& options, const MapLimits& limits = {});

/// A grid of the scans to be drawn behind a graph. Its cells have the size `options.resolution`, or
/// are larger if the map would otherwise have more than 1,200 cells a side. Scans without a place
/// are left out.
OccupancyGrid RenderBackdrop(std::span<const SE2> poses,
                             const std::function<MapScan(std::size_t)>& scan_at,
                             OccupancyGridOptions options = {});

}  // namespace loopgrid
