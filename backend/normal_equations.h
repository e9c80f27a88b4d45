#pragma once

#include <Eigen/Core>
#include <vector>

#include "backend/pose_graph.h"
#include "backend/robust_loss.h"
#include "backend/symmetric_block_matrix.h"

namespace loopgrid {

/// The Hessian H = sum J^T Omega J and gradient b = sum J^T Omega e of a graph (lines 6-13 of the
/// tutorial's Algorithm 2), over the nodes that are not held (see HeldNodes). The block structure
/// is built once; when the graph has grown at its end since the last call, only the new part is
/// added.
class NormalEquations {
 public:
  /// Adopts the structure of the graph. True if the block pattern of the Hessian changed.
  bool SetStructure(const PoseGraph& graph);

  /// Computes H and b at the graph's poses, each constraint weighted by its loss; returns F.
  double Linearize(const PoseGraph& graph, const RobustLoss& loss);

  /// F alone.
  static double Error(const PoseGraph& graph, const RobustLoss& loss);

  /// Position of a node among the variables, -1 for a held node. Variables keep the nodes' order.
  int variable(int node) const { return variable_of_node_[static_cast<std::size_t>(node)]; }
  int variable_count() const { return hessian_.cols(); }

  /// See ConnectedComponents.
  const std::vector<int>& components() const { return components_; }

  const SymmetricBlockMatrix<3>& hessian() const { return hessian_; }
  const Eigen::VectorXd& gradient() const { return gradient_; }

 private:
  struct Link {
    int from;  // nodes
    int to;
    int block;  // off-diagonal block in the Hessian, -1 if an end is held
  };

  bool IsGrown(const PoseGraph& graph, const std::vector<int>& held) const;
  void AddNodes(int count, const std::vector<int>& held);

  std::vector<int> components_;
  std::vector<int> held_;
  std::vector<int> variable_of_node_;
  std::vector<Link> links_;  // one per constraint
  SymmetricBlockMatrix<3> hessian_;
  Eigen::VectorXd gradient_;
};

}  // namespace loopgrid
