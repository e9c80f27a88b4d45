#pragma once

#include <vector>

#include "backend/graph/pose_graph.h"
#include "frontend/closing/closure_matcher.h"
#include "frontend/closing/nodes.h"

namespace loopgrid {

struct NeighbourLinkerOptions {
  ClosureMatcherOptions matcher;
  double distance = 3.0;     ///< nodes this close may see the same surfaces, metres
  int same_pass = 10;        ///< nodes this close along the path belong to one pass
  int already_linked = 3;    ///< a closure this many nodes away spares a link
  double map_path = 5.0;     ///< travel before and after a node that makes its map, metres
  double map_radius = 25.0;  ///< surfaces farther from the node are left out, metres
  SearchWindow window{0.1, 0.1, 0.03};  ///< around what the graph says
  double max_denied_share = 0.2;        ///< see Visibility, 0..1
  double max_shift = 0.2;  ///< a match this far from the graph's opinion is not believed, metres
  double max_turn = 0.06;  ///< ... or turned this much, radians
};

/// Constraints between nodes that came by the same place on different passes and have no closure
/// yet, for a graph that is right to a few centimetres: the scan of each node against the map
/// around the nearest node of every other pass.
std::vector<Constraint<SE2>> LinkNeighbours(const Nodes& nodes,
                                            const NeighbourLinkerOptions& options = {});

}  // namespace loopgrid
