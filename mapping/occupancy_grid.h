#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "backend/geometry/se2.h"
#include "mapping/log_odds.h"
#include "mapping/ray_walk.h"

namespace loopgrid {

struct OccupancyGridOptions {
  double resolution = 0.05;              ///< side of a cell, metres
  double hit_log_odds = kHitLogOdds;     ///< added where a beam of a scan ends
  double miss_log_odds = kMissLogOdds;   ///< added where beams only pass
  double max_log_odds = kMaxLogOdds;     ///< evidence stops growing here, in both directions
  double no_return_range = 3.0;          ///< a beam without a return clears up to here, metres
  std::int64_t max_cells = 200'000'000;  ///< 4 bytes each; a larger map is refused

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

/// One scan as a map sees it; coordinates in the scan's own frame, metres.
struct MapScan {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< where the beams start: the laser
  std::span<const Eigen::Vector2f> hits;             ///< where beams ended
  std::span<const Eigen::Vector2f> no_returns;       ///< unit vectors along beams without a return
};

/// A rectangle of cells: first inclusive, last exclusive.
struct CellBox {
  std::int64_t min_x = 0;
  std::int64_t min_y = 0;
  std::int64_t max_x = 0;
  std::int64_t max_y = 0;

  bool empty() const { return max_x <= min_x || max_y <= min_y; }
  std::int64_t width() const { return max_x - min_x; }
  std::int64_t height() const { return max_y - min_y; }
  bool Contains(const CellBox& other) const;
  /// The smallest box around both; an empty box adds nothing.
  CellBox United(const CellBox& other) const;
};

enum class CellState : std::uint8_t { kUnknown, kFree, kWall };

/// A log-odds occupancy grid (Moravec and Elfes 1985) that grows as scans are added. Cell (i, j)
/// covers [i, i + 1) x [j, j + 1) times the resolution, in the map frame; it keeps its index when
/// the grid grows. A scan counts once for each cell: as a hit if any of its beams ends there, else
/// as a miss if any beam crosses it. Evidence is counted in whole hundredths, so the order of the
/// scans does not matter, except where `max_log_odds` is reached.
class OccupancyGrid {
 public:
  /// Throws Error (kUsage) if the options are not valid.
  explicit OccupancyGrid(const OccupancyGridOptions& options = {});

  /// The cells that a scan seen from `T_map_scan` touches. Throws Error (kInput) if a coordinate
  /// is not finite or too far out to have a cell.
  CellBox BoxOf(const SE2& T_map_scan, const MapScan& scan) const;

  /// Makes room for `box`. Throws Error (kUsage) if that needs more than `max_cells`.
  void Reserve(const CellBox& box);

  /// Adds a scan, growing as needed. Throws as BoxOf and Reserve do, and then changes nothing.
  void AddScan(const SE2& T_map_scan, const MapScan& scan);

  /// Log-odds of a cell being occupied; 0 where nothing is known, also outside the grid.
  double LogOdds(std::int64_t cell_x, std::int64_t cell_y) const;

  CellState State(std::int64_t cell_x, std::int64_t cell_y) const;

  /// The smallest box around all cells whose state is known.
  CellBox SeenBox() const;

  const OccupancyGridOptions& options() const { return options_; }
  double resolution() const { return options_.resolution; }

 private:
  struct Cell {
    std::int16_t evidence = 0;    // log-odds in hundredths
    std::uint16_t last_scan = 0;  // the scan that touched it last, see NextScanNumber
  };

  // A scan on the grid.
  struct Beams {
    GridPoint origin;
    std::vector<GridPoint> hits;
    std::vector<GridPoint> no_return_ends;
  };

  GridPoint ToGrid(const Eigen::Vector2d& p_map) const;
  void Project(const SE2& T_map_scan, const MapScan& scan, Beams* beams) const;
  static CellBox BoxOf(const Beams& beams);
  void RequireAffordable(const CellBox& box) const;
  std::uint16_t NextScanNumber();
  const Cell* Find(std::int64_t cell_x, std::int64_t cell_y) const;
  std::size_t IndexOf(std::int64_t cell_x, std::int64_t cell_y) const;
  void MarkHits(std::uint16_t scan_number);
  void ClearRays(std::uint16_t scan_number);

  OccupancyGridOptions options_;
  double grid_points_per_metre_;
  int hit_;
  int miss_;
  int limit_;
  std::uint16_t scan_number_ = 0;
  CellBox box_;              // what `cells_` covers
  std::vector<Cell> cells_;  // row-major, first row has the smallest y
  Beams beams_;              // of the scan being added; a member to save allocations
};

/// The map of `poses.size()` scans; scan i was taken at poses[i] (T_map_scan). `scan_at(i)` is
/// called twice for each i, in order: first to find the extent, then to draw. So only the grid is
/// kept in memory. Throws as OccupancyGrid does; the message names the scan.
OccupancyGrid RenderMap(std::span<const SE2> poses,
                        const std::function<MapScan(std::size_t)>& scan_at,
                        const OccupancyGridOptions& options = {});

}  // namespace loopgrid
