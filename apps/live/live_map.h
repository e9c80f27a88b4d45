#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "apps/live/map_tiles.h"
#include "apps/live/online_update.h"
#include "mapping/occupancy_grid.h"

namespace loopgrid {

struct LiveMapOptions {
  OccupancyGridOptions grid;
  double publish_interval = 0.1;  ///< the picture changes at most this often, seconds
  double redraw_pause = 4.0;      ///< time between the starts of two redraws, as a multiple of
                                  ///< the time that the redraw took

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

/// The map while it grows. A thread of its own draws each scan, and draws all scans again when
/// nodes have moved. Memory: 4 bytes for each cell of the grid (8 while it redraws; at most
/// `grid.max_cells` cells), 1.4 bytes for each cell of the tiles, and about 100 bytes for each scan
/// without its points, which are shared. All methods may be called from any thread.
///
/// The cells keep their size, because viewers have the tiles. So there is one rule at any time: a
/// scan for which the grid would need more than `grid.max_cells` cells is left out and counted; the
/// next redraw tries it again. RenderFittedMap(), which draws the map at the end, has all scans at
/// once and makes the cells larger instead.
class LiveMap {
 public:
  /// Throws Error (kUsage) if the options are not valid.
  explicit LiveMap(const LiveMapOptions& options = {});
  ~LiveMap();
  LiveMap(const LiveMap&) = delete;
  LiveMap& operator=(const LiveMap&) = delete;

  /// Takes the scan (if it has points) and the nodes (if they have moved). Returns at once.
  void Add(const OnlineUpdate& update);

  /// Waits until the picture shows all that was added before, moved nodes included.
  void WaitUntilCurrent();

  /// The whole map so far, drawn coarser where it would be too large for an image; for map.yaml see
  /// MapYaml().
  MapPicture Picture() const;
  double resolution() const;  ///< side of a cell, metres

  const MapTiles& tiles() const;

  struct Counters {
    std::int64_t scans = 0;     ///< taken from the queue
    std::int64_t left_out = 0;  ///< scans that do not fit into `max_cells`
    std::int64_t redraws = 0;
    std::size_t waiting = 0;  ///< updates in the queue
  };
  Counters counters() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace loopgrid
