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

/// The minimum of F with its two difficulties taken out one after the other: first the rotations as
/// if they were any matrices, which is linear, then moved to the nearest rotations; then, given
/// them, positions and landmarks, which is linear too (Carlone, Tron, Daniilidis and Dellaert, ICRA
/// 2015: chordal relaxation). What is marked robust counts a millionth of its information, so that
/// gross outliers hardly move the guess. Does not depend on the poses, but for those of held nodes
/// and of parts that only landmarks join to them. False, and the graph as it was, if either system
/// is not positive definite: constraints without information on some rotation or position.
template <typename Pose>
[[nodiscard]] bool SetChordalGuess(PoseGraph<Pose>* graph);

}  // namespace loopgrid
