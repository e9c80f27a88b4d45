#pragma once

#include <span>
#include <string>

#include "backend/graph_tag.h"

namespace loopgrid {

/// The lines that TORO (Grisetti et al. 2009) reads:
///
///     VERTEX2 id x y theta                 EDGE2 from to x y theta Ixx Ixy Iyy Itt Ixt Iyt
///     VERTEX3 id x y z roll pitch yaw      EDGE3 from to x y z roll pitch yaw I
///
/// VERTEX and EDGE are older names of VERTEX2 and EDGE2. I is the upper triangle of the information
/// matrix, row by row, over (x, y, z, roll, pitch, yaw).
template <typename Pose>
std::span<const GraphTag<Pose>> ToroTags();

/// The graph must have no landmarks.
template <typename Pose>
std::string FormatToro(const PoseGraph<Pose>& graph, const GraphIds& ids);

}  // namespace loopgrid
