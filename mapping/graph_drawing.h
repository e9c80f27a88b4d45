#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "mapping/occupancy_grid.h"

namespace loopgrid {

enum class EdgeKind {
  kSequential,  ///< between consecutive nodes, or nearly so: the robot's path
  kClosure,     ///< between nodes that met again later
};

/// A constraint as a picture sees it: indices of two nodes.
struct GraphEdge {
  int from = 0;
  int to = 0;
  EdgeKind kind = EdgeKind::kSequential;
};

/// One state of a graph, map frame, metres; in 2D z is 0.
struct GraphState {
  std::string title = {};
  std::vector<Eigen::Vector3d> nodes = {};
  std::vector<Eigen::Vector3d> landmarks = {};
  const OccupancyGrid* backdrop = nullptr;  ///< the map at these poses; only for kAbove
};

enum class Viewpoint {
  kAbove,    ///< x to the right, y upwards
  kOblique,  ///< z upwards, x and y at an angle; what is farther away is paler
};

/// graph.png: the constraints before and after optimisation side by side, each over its map, in the
/// manner of the tutorial's Fig. 9, and landmarks as dots. Lines get finer where there are many. At
/// most 2,400 pixels a side. Throws Error (kUsage) if a position is not finite or an edge names a
/// node that is not there.
std::string DrawGraphBeforeAfter(const GraphState& before, const GraphState& after,
                                 std::span<const GraphEdge> edges,
                                 Viewpoint viewpoint = Viewpoint::kAbove);

}  // namespace loopgrid
