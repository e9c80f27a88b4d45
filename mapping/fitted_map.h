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

/// What a map may become before scans are left out of it.
struct MapLimits {
  std::int64_t max_side = kMaxMapSide;  ///< cells a side
  double coarsest = 1.0;                ///< side of a cell, metres
};

/// A map of all scans that fit on one.
struct FittedMap {
  OccupancyGrid grid;
  std::vector<std::size_t> left_out;  ///< indices of the scans that are not on it, ascending
};

/// RenderMap for scans at any places. A map that would have more than `options.max_cells` cells, or
/// more than `limits.max_side` a side, gets larger cells: `options.resolution` times the smallest
/// whole number that makes it fit. Scans far from the others are left out where one in a hundred of
/// them (or a single one) would make the cells more than twice as large, or where cells of
/// `limits.coarsest` would not do; scans without a place (not finite, or beyond the largest cell
/// index) always are. Throws Error (kUsage) if the options are not valid, or too narrow for any
/// map.
FittedMap RenderFittedMap(std::span<const SE2> poses,
                          const std::function<MapScan(std::size_t)>& scan_at,
                          const OccupancyGridOptions& options, const MapLimits& limits = {});

/// A grid of the scans that is just fine enough to be drawn behind a graph, whatever the extent:
/// cells of `options.resolution`, or larger ones where a side of the map would need more than 1,200
/// of them. Scans without a place are left out.
OccupancyGrid RenderBackdrop(std::span<const SE2> poses,
                             const std::function<MapScan(std::size_t)>& scan_at,
                             OccupancyGridOptions options = {});

}  // namespace loopgrid
