#pragma once

#include <span>
#include <string>
#include <string_view>

#include "backend/files/graph_tag.h"

namespace loopgrid {

/// The lines that g2o (Kuemmerle et al. 2011) writes for a graph of poses:
///
///     VERTEX_SE2 id x y theta                   EDGE_SE2 from to x y theta I
///     VERTEX_XY id x y                          EDGE_SE2_XY node landmark x y I
///     VERTEX_SE3:QUAT id x y z qx qy qz qw      EDGE_SE3:QUAT from to x y z qx qy qz qw I
///     VERTEX_TRACKXYZ id x y z                  EDGE_SE3_TRACKXYZ node landmark sensor x y z I
///     PARAMS_SE3OFFSET sensor x y z qx qy qz qw
///
/// I is the upper triangle of the information matrix, row by row, in the order of Pose::Tangent.
/// An observation in a sensor's frame is transformed into the node's frame, and is written as one
/// in the node's frame.
template <typename Pose>
std::span<const GraphTag<Pose>> G2oTags();

/// Whether a line with this tag has data that g2o stores in the same file as the graph, and that
/// says nothing about the poses: laser measurements at a vertex (ROBOTLASER1, RAWLASER1), a label
/// or an ellipse to draw there (VERTEX_TAG, VERTEX_ELLIPSE), or a parameter (PARAMS_...).
/// Parameters that edges in G2oTags() refer to are read.
bool IsG2oData(std::string_view tag);

template <typename Pose>
std::string FormatG2o(const PoseGraph<Pose>& graph, const GraphIds& ids);

}  // namespace loopgrid
