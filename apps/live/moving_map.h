#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "frontend/matching/point_scan.h"
#include "frontend/slam/slam.h"
#include "mapping/occupancy_grid.h"

namespace loopgrid {

/// A scan for the map.
struct ScanOnMap {
  ScanPlace place;
  SE2 T_map_robot;        ///< gives the pose of the node if the node is new
  bool localized = true;  ///< false: the robot has not found itself in the old map yet; the scan is
                          ///< not drawn until it has
  std::shared_ptr<const PointScan> points;
};

/// An occupancy grid of scans whose poses are relative to the nodes of a graph. When nodes move,
/// the scans are drawn again into a second grid, a few at a time. Until that grid is complete, the
/// first one is used, and new scans are drawn into it. Memory: 4 bytes for each cell, 8 during a
/// redraw, and about 100 bytes for each scan without its points, which are shared. One thread may
/// use an object at a time.
class MovingMap {
 public:
  /// Throws Error (kUsage) if the options are not valid.
  explicit MovingMap(const OccupancyGridOptions& options = {});

  /// Draws a scan and remembers it. One that does not fit into the grid is left out and counted.
  void AddScan(const ScanOnMap& scan);

  /// Sets the present poses of the nodes (T_map_node).
  void MoveNodes(std::span<const SE2> poses);

  /// Whether some node has moved since it was drawn: by half a cell, or by an angle that moves a
  /// point ten metres away by half a cell.
  bool IsOutdated() const { return outdated_; }

  /// Begins to draw all scans again.
  void StartRedraw();
  bool IsRedrawing() const { return next_.has_value(); }

  /// Draws the next `scans` scans. After the last ones, grid() is the new grid.
  void ContinueRedraw(std::size_t scans);

  const OccupancyGrid& grid() const { return grid_; }

  /// A box around all cells that may have changed since the last call.
  CellBox TakeChanges();

  std::size_t scans() const { return scans_.size(); }
  std::int64_t left_out() const { return left_out_; }  ///< scans that did not fit

 private:
  struct Entry {
    ScanPlace place;
    std::shared_ptr<const PointScan> points;
  };
  struct Redraw {
    OccupancyGrid grid;
    std::vector<SE2> nodes;  // as drawn: at the start, or when added
    CellBox extent;
    std::size_t drawn = 0;  // scans
    std::int64_t left_out = 0;
  };

  SE2& NodePose(const ScanOnMap& scan);
  bool Draw(const Entry& entry, const SE2& T_map_node, OccupancyGrid* grid, CellBox* extent);
  void FinishRedraw();
  void CompareWithDrawn();

  OccupancyGrid grid_;
  std::vector<Entry> scans_;
  std::vector<SE2> nodes_;        // T_map_node now
  std::vector<SE2> drawn_nodes_;  // T_map_node that grid_ shows
  std::size_t drawable_ = 0;      // scans whose session is localized
  std::optional<Redraw> next_;
  CellBox extent_;  // of what grid_ shows
  CellBox changes_;
  bool outdated_ = false;
  std::int64_t left_out_ = 0;
};

}  // namespace loopgrid
