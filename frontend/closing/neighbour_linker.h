#pragma once

#include <vector>

#include "backend/graph/pose_graph.h"
#include "frontend/closing/closing_options.h"
#include "frontend/closing/closure_matcher.h"
#include "frontend/closing/nodes.h"

namespace loopgrid {

/// Constraints between nodes that came by the same place on different passes and have no closure
/// yet, for a graph that is right to a few centimetres: the scan of each node against the map
/// around the nearest node of every other pass.
std::vector<Constraint<SE2>> LinkNeighbours(const Nodes& nodes,
                                            const NeighbourLinkerOptions& options = {});

}  // namespace loopgrid
