#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "backend/graph/pose_graph.h"
#include "backend/graph/robust_loss.h"
#include "backend/solve/normal_equations.h"
#include "backend/sparse/sparse_cholesky.h"

namespace loopgrid {

/// Marginal covariances of the nodes and landmarks of a graph: blocks of the inverse Hessian, those
/// of nodes in each node's own frame, in the order of Pose::Tangent, those of landmarks in the map
/// frame. Refers to the equations and the factor that it is made from. Asking for a node that the
/// graph does not have is an Error (kInput).
template <typename Pose>
class Marginals {
 public:
  static constexpr int kDof = Pose::kDof;
  static constexpr int kPoint = Pose::Point::RowsAtCompileTime;
  using Covariance = Eigen::Matrix<double, kDof, kDof>;
  using PointCovariance = Eigen::Matrix<double, kPoint, kPoint>;

  /// `factor` is that of the equations' undamped Hessian, linearised where the graph is, on the
  /// manifold and with this loss.
  Marginals(const PoseGraph<Pose>& graph, const NormalEquations<Pose>& equations,
            const SparseCholesky<kDof>& factor, const RobustLoss& loss);

  /// Of every node relative to the held node of its component; zero for held nodes.
  const std::vector<Covariance>& covariances() const { return covariances_; }

  /// Of every landmark, likewise; zero for those that no node has seen.
  const std::vector<PointCovariance>& landmark_covariances() const { return landmark_covariances_; }

  /// Covariance of every node (rows) with one node (columns): one solve with kDof columns.
  std::vector<Covariance> CrossCovariances(int node) const;

  /// Covariance of the first node (rows) with the second (columns) for each pair, in their order:
  /// one solve for each different second node. A pair may come several times.
  std::vector<Covariance> PairCovariances(std::span<const std::pair<int, int>> pairs) const;

  struct Relative {
    std::vector<Covariance>
        nodes;  ///< each in its own frame; zero for the node they are relative to
    std::vector<PointCovariance> landmarks;  ///< each in the map frame
  };

  /// Of every node and landmark relative to `node`: the diagonal blocks of the inverse of H without
  /// the rows and columns of `node` (H_red in Section IV-F of the tutorial). Infinite on the
  /// diagonal for nodes and landmarks of other components.
  ///
  /// They come from the joint covariance with the held node, by one solve. This is no
  /// approximation: the errors do not change when all nodes move together, so H has these motions
  /// in its null space, and changing the node that is held is linear. But far from the held node
  /// the difference of two large covariances may be small. Where any of them would lose too many
  /// digits, the graph is linearised and factorised again with `node` held, for all of them; with
  /// twice the digits where double precision might not give variances right to a millionth.
  ///
  /// With several fixed nodes in the component of `node` all of them stay where they are, and
  /// there is no second factorisation.
  Relative RelativeTo(int node) const;

 private:
  /// The columns of the inverse that belong to a node; empty if it is held.
  Eigen::MatrixXd ColumnsOf(int node) const;
  void RequireNode(int node) const;
  /// Relative to `node`, as differences of covariances with the held node; nothing is said about
  /// other components. `are_exact` becomes false where too many digits are lost.
  Relative Differences(int node, bool* are_exact) const;
  Covariance NodeDifference(int i, int node, const Covariance& cross, bool* is_exact) const;
  PointCovariance LandmarkDifference(int i, int node,
                                     const Eigen::Matrix<double, kPoint, kDof>& cross,
                                     bool* is_exact) const;
  /// The same with `node` held instead of the node that is held in its component. Nothing if
  /// several nodes of the component are fixed, or if the Hessian is not positive definite.
  std::optional<Relative> WithHeld(int node) const;

  PoseGraph<Pose> graph_;
  RobustLoss loss_;
  const NormalEquations<Pose>* equations_;
  const SparseCholesky<kDof>* factor_;
  std::vector<Covariance> covariances_;
  std::vector<PointCovariance> landmark_covariances_;
};

/// Marginals::RelativeTo, of the nodes, for a graph of which nothing else is wanted. Nothing if the
/// Hessian is not positive definite; throws Error (kInput) if the graph is not valid or has no such
/// node.
template <typename Pose>
std::optional<std::vector<typename Marginals<Pose>::Covariance>> RelativeCovariances(
    const PoseGraph<Pose>& graph, int node, const RobustLoss& loss = {});

/// Carries covariances relative to the last node but one (as of Marginals::RelativeTo) over to the
/// last node, which only `link` joins to the graph, from the node before it: what a new
/// factorisation would give, without one. `covariances` has an entry a node but the last; it gets
/// that one too.
template <typename Pose>
void ExtendRelativeCovariances(const PoseGraph<Pose>& graph, const Constraint<Pose>& link,
                               std::vector<typename Marginals<Pose>::Covariance>* covariances);

extern template class Marginals<SE2>;
extern template class Marginals<SE3>;

}  // namespace loopgrid
