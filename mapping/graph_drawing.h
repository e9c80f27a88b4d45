#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "backend/geometry/se2.h"
#include "mapping/occupancy_grid.h"

namespace loopgrid {

enum class EdgeKind {
  kSequential,  ///< between consecutive nodes, or nearly so: the robot's way
  kClosure,     ///< between nodes that met again later
};

/// A constraint as a picture sees it: indices of two nodes.
struct GraphEdge {
  int from = 0;
  int to = 0;
  EdgeKind kind = EdgeKind::kSequential;
};

/// A grid of the scans that is just fine enough to be drawn behind a graph, whatever the extent:
/// RenderMap with cells of `options.resolution`, or larger ones where a side of the map would need
/// more than 1,200 of them.
OccupancyGrid RenderBackdrop(std::span<const SE2> poses,
                             const std::function<MapScan(std::size_t)>& scan_at,
                             OccupancyGridOptions options = {});

/// One state of a graph: the poses T_map_node of its nodes and the map that goes with them.
struct GraphState {
  std::span<const SE2> nodes;
  const OccupancyGrid* backdrop = nullptr;
};

/// graph.png: the constraints before and after optimisation side by side, each over its map, in the
/// manner of the tutorial's Fig. 9. At most 2,400 pixels a side. Throws Error (kUsage) if a pose is
/// not finite or an edge names a node that is not there.
std::string DrawGraphBeforeAfter(const GraphState& before, const GraphState& after,
                                 std::span<const GraphEdge> edges);

/// uncertainty.png: the 3 sigma ellipses of the nodes' positions relative to the robot's last pose,
/// which is the last node (the tutorial's Fig. 10). Covariances are in each node's own frame, order
/// (x, y, theta); those that are none (not finite, indefinite) are left out. Throws Error (kUsage)
/// if a pose is not finite or there is not one covariance a node.
std::string DrawUncertainty(const GraphState& state, std::span<const Eigen::Matrix3d> covariances);

}  // namespace loopgrid
