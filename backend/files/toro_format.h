#pragma once

#include <span>
#include <string>

#include "backend/files/graph_tag.h"

namespace loopgrid {

/// The lines that TORO (Grisetti et al. 2009) reads:
///
///     VERTEX2 id x y theta                 EDGE2 from to x y theta Ixx Ixy Iyy Itt Ixt Iyt
///     VERTEX3 id x y z roll pitch yaw      EDGE3 from to x y z roll pitch yaw I
///
/// VERTEX and EDGE are older names of VERTEX2 and EDGE2. In 3D, I is the upper triangle of the
/// information matrix, row by row, over (x, y, z, roll, pitch, yaw). Ours is over the vector part
/// of the quaternion: J^T I J, J being the derivative of the angles by it, which is twice the
/// identity at zero. J is taken as g2o takes it when it reads these lines, so that F of a file
/// is what g2o computes: sphere-mednoise has its known minimum of 395.006212; it would be 383.18
/// with J at zero, and 384.79 with the exact one for motions in the body's frame.
template <typename Pose>
std::span<const GraphTag<Pose>> ToroTags();

/// The graph must have no landmarks.
template <typename Pose>
std::string FormatToro(const PoseGraph<Pose>& graph, const GraphIds& ids);

}  // namespace loopgrid
