#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "backend/normal_equations.h"
#include "backend/pose_graph.h"
#include "backend/robust_loss.h"
#include "backend/sparse_cholesky.h"

namespace loopgrid {

/// Marginal covariances of the nodes of a graph at its poses: blocks of the inverse Hessian, each
/// in the frame of its own node (SE2::Boxplus), order (x, y, theta). Refers to the factor that it
/// is made from.
class Marginals {
 public:
  /// `factor` is that of the equations' undamped Hessian, linearised at these poses.
  Marginals(std::vector<SE2> poses, const NormalEquations& equations,
            const SparseCholesky<3>& factor);

  /// Of every node relative to the held node of its component; zero for held nodes.
  const std::vector<Eigen::Matrix3d>& covariances() const { return covariances_; }

  /// Covariance of every node (rows) with one node (columns): one solve with three columns.
  std::vector<Eigen::Matrix3d> CrossCovariances(int node) const;

  /// Of every node relative to `node`: the diagonal blocks of the inverse of H without the rows and
  /// columns of `node` (H_red in Section IV-F of the tutorial); zero for `node` itself. Infinite
  /// on the diagonal for nodes of other components. They come from the joint covariance with the
  /// held node, which is no approximation: the errors do not change when all nodes move together,
  /// so H has these motions in its null space, and changing the node that is held is linear. Only
  /// with several fixed nodes in a component do they differ: those are then known exactly.
  std::vector<Eigen::Matrix3d> RelativeTo(int node) const;

 private:
  std::vector<SE2> poses_;
  const NormalEquations* equations_;
  const SparseCholesky<3>* factor_;
  std::vector<Eigen::Matrix3d> covariances_;
};

/// Marginals::RelativeTo for a graph of which nothing else is wanted. Nothing if the Hessian is not
/// positive definite; throws Error (kInput) if the graph is not valid or has no such
/// node.
std::optional<std::vector<Eigen::Matrix3d>> RelativeCovariances(const PoseGraph& graph, int node,
                                                                const RobustLoss& loss = {});

/// Carries covariances relative to the last node but one (as of Marginals::RelativeTo) over to the
/// last node, which only `link` joins to the graph, from the node before it: what a new
/// factorisation would give, without one. `covariances` has an entry a node but the last; it gets
/// that one too.
void ExtendRelativeCovariances(const PoseGraph& graph, const Constraint& link,
                               std::vector<Eigen::Matrix3d>* covariances);

}  // namespace loopgrid
