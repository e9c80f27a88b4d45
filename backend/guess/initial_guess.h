#pragma once

#include "backend/graph/pose_graph.h"

namespace loopgrid {

/// Poses composed from the constraints along a tree that starts at the held nodes (see HeldNodes)
/// and reaches every node by the path on which the variances of the rotations add up to the least;
/// over constraints that may be wrong only where there is no other way. A landmark starts where its
/// most certain observation puts it. Nodes that only landmarks join to a held one, the first of
/// each such part, stay where they are, and so do landmarks that no node has seen.
template <typename Pose>
void SetSpanningTreeGuess(PoseGraph<Pose>* graph);

/// Chordal relaxation (Carlone, Tron, Daniilidis and Dellaert, ICRA 2015): approximates the minimum
/// of F by two linear problems. The first finds rotations as arbitrary matrices and replaces each
/// by the nearest rotation. The second finds positions and landmarks for these rotations. Edges
/// marked robust are weighted by 1e-6, so that gross outliers hardly move the guess. The result
/// depends on the poses of held nodes, and on those of parts that only landmarks join to held
/// nodes, but on no other pose. Returns false and leaves the graph unchanged if one of the linear
/// systems is not positive definite, because no constraint determines some rotation or position.
template <typename Pose>
[[nodiscard]] bool SetChordalGuess(PoseGraph<Pose>* graph);

}  // namespace loopgrid
