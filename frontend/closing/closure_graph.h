#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "backend/graph/pose_graph.h"
#include "backend/solve/optimizer.h"

namespace loopgrid {

/// Covariance of a pose known to `first`, followed by a step known to `second`, each in the frame
/// of its end, order (x, y, theta); the result is in the frame of the step's end.
Eigen::Matrix3d ComposeCovariances(const Eigen::Matrix3d& first, const SE2& step,
                                   const Eigen::Matrix3d& second);

/// The pose graph as SLAM grows it: a chain of nodes, and closures that are believed only as long
/// as the rest of the graph lets them. Knows no scans.
class ClosureGraph {
 public:
  ClosureGraph();

  const PoseGraph<SE2>& graph() const { return graph_; }
  int size() const { return static_cast<int>(graph_.poses.size()); }

  /// Adds a node at `T_map_node`, joined to `parent` (-1: the last one) by what `T_parent_node`
  /// (with `covariance`, frame of the new node) says. The first node takes no constraint.
  void AddNode(const SE2& T_map_node, const SE2& T_parent_node, const Eigen::Matrix3d& covariance,
               int parent = -1);

  /// Moves all nodes from `first` on by the same motion of the map frame.
  void MoveNodes(int first, const SE2& motion);

  /// Adds closures and optimises. As long as that leaves some closure, old or new, off by more than
  /// kMaxChi2, the worst goes out again; old ones only while fewer than the new ones that stay. If
  /// none of the new ones would stay, the graph is left as it was: false. What went out is put into
  /// `removed`.
  bool TryClosures(std::span<const Constraint<SE2>> closures,
                   std::vector<Constraint<SE2>>* removed = nullptr);

  /// Ends the run: adds `links`, optimises to convergence, and takes out closures and links that
  /// are off by more than kMaxChi2, the worst first. Returns those.
  std::vector<Constraint<SE2>> Settle(std::span<const Constraint<SE2>> links);

  /// Covariance of every node relative to the last one, each in its own frame.
  const std::vector<Eigen::Matrix3d>& relative_covariances() const { return covariances_; }

  /// Covariance of every node relative to the first one, each in its own frame.
  const std::vector<Eigen::Matrix3d>& map_covariances() const { return map_covariances_; }

  /// chi-square e^T Omega e of a constraint at the present poses.
  double Chi2(const Constraint<SE2>& constraint) const;

  static constexpr double kMaxChi2 = 25.0;  ///< five sigmas

 private:
  // Index of the constraint of the closure that is off the most, -1 if none is off too much.
  int WorstClosure() const;
  void UpdateCovariances(Optimizer<SE2>* optimizer, int relative_to);

  PoseGraph<SE2> graph_;
  Optimizer<SE2> optimizer_;
  std::vector<Eigen::Matrix3d> covariances_;
  std::vector<Eigen::Matrix3d> map_covariances_;
};

}  // namespace loopgrid
