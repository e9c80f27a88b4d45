#pragma once

#include <vector>

#include "backend/graph/pose_graph.h"
#include "frontend/closing/closing_options.h"
#include "frontend/closing/closure_matcher.h"
#include "frontend/closing/nodes.h"

namespace loopgrid {

/// Finds constraints between nodes of different passes by the same place that have no closure yet:
/// matches the scan of each node with the map around the nearest node of every other pass. The
/// graph has to be right to a few centimetres.
std::vector<Constraint<SE2>> LinkNeighbours(const Nodes& nodes,
                                            const NeighbourLinkerOptions& options = {});

}  // namespace loopgrid
