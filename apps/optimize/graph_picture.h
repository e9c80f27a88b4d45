#pragma once

#include <string>
#include <vector>

#include "apps/optimize/id_order.h"
#include "backend/graph/pose_graph.h"
#include "mapping/graph_drawing.h"

namespace loopgrid {

/// The poses and landmarks of a graph, in the form that mapping/ draws.
template <typename Pose>
GraphState StateOf(const PoseGraph<Pose>& graph, const std::string& title);

/// Its constraints: closures are those that do not join a node to the next one by id.
template <typename Pose>
std::vector<GraphEdge> EdgesOf(const PoseGraph<Pose>& graph, const IdOrder& order);

/// The view: from above in 2D, oblique in 3D.
template <typename Pose>
constexpr Viewpoint ViewpointFor() {
  return Pose::kDof == 3 ? Viewpoint::kAbove : Viewpoint::kOblique;
}

}  // namespace loopgrid
