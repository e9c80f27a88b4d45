#pragma once

#include <Eigen/Core>
#include <vector>

#include "backend/geometry/se2.h"

namespace loopgrid {

/// A measured relative pose between two nodes with its information matrix.
struct Constraint {
  int from = 0;
  int to = 0;
  SE2 T_from_to;  ///< measured pose of `to` in `from`
  Eigen::Matrix3d information =
      Eigen::Matrix3d::Identity();  ///< order (x, y, theta), in `to`'s measured frame
  bool robust = false;              ///< may be wrong: the optimiser's robust loss applies to it
};

/// The graph of the tutorial: poses are nodes, constraints are edges. Plain data.
struct PoseGraph {
  std::vector<SE2> poses;  ///< T_map_node
  std::vector<Constraint> constraints;
  std::vector<int> fixed;  ///< nodes that an optimiser must not move
};

/// Throws Error (kInput) naming the first pose or constraint that is not finite, and the first
/// constraint or fixed node whose index is not a node's, or that joins a node to itself.
void Validate(const PoseGraph& graph);

/// For each node the first node (lowest index) of the part of the graph it is connected to.
std::vector<int> ConnectedComponents(const PoseGraph& graph);

/// The nodes that make the optimum unique, ascending: `graph.fixed`, and the first node of each
/// component (see ConnectedComponents) without a fixed node. Which node of a component is held
/// makes no difference to relative poses.
std::vector<int> HeldNodes(const PoseGraph& graph, const std::vector<int>& components);

}  // namespace loopgrid
