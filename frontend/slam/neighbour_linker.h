#pragma once

#include <vector>

#include "backend/pose_graph.h"
#include "frontend/matching/match_refiner.h"
#include "frontend/slam/nodes.h"

namespace loopgrid {

struct NeighbourLinkerOptions {
  RefinerOptions refiner;
  double distance = 4.0;     ///< nodes this close may see the same surfaces, metres
  int recent_nodes = 10;     ///< nodes this close along the path are linked already
  int same_pass = 10;        ///< neighbours this close along the path are one pass
  double map_path = 5.0;     ///< travel before and after the neighbour that makes its map, metres
  double map_radius = 25.0;  ///< surfaces farther from the neighbour are left out, metres
  double min_inlier_share = 0.6;  ///< of the refined match, 0..1
  double max_shift = 0.3;  ///< a match this far from the graph's opinion is not believed, metres
  double max_turn = 0.1;   ///< ... or turned this much, radians
};

/// Constraints between nodes that came by the same place on different passes, for a graph that is
/// already right to a few centimetres: the scan of each node against the map around the nearest
/// node of every other pass.
std::vector<Constraint> LinkNeighbours(const Nodes& nodes, const NeighbourLinkerOptions& options);

}  // namespace loopgrid
