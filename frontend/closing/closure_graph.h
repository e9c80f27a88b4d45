#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "backend/graph/pose_graph.h"
#include "backend/solve/optimizer.h"
#include "frontend/closing/closing_options.h"
#include "frontend/closing/closure.h"

namespace loopgrid {

/// A closure and its constraint.
struct ClosureConstraint {
  ClosureId id = kNoClosure;
  Constraint<SE2> constraint;
};

/// The pose graph: a chain of nodes, and closures between them. A closure that contradicts the rest
/// of the graph is removed. This class knows no scans.
class ClosureGraph {
 public:
  explicit ClosureGraph(const ClosureGraphOptions& options = {});

  const PoseGraph<SE2>& graph() const { return graph_; }
  int size() const { return static_cast<int>(graph_.poses.size()); }

  /// Adds a node at `T_map_node` and a constraint from `parent` (-1: the last node) with the
  /// measured pose `T_parent_node` and its `covariance` (frame of the new node). The first node
  /// gets no constraint.
  void AddNode(const SE2& T_map_node, const SE2& T_parent_node, const Eigen::Matrix3d& covariance,
               int parent = -1);

  /// Moves all nodes from `first` on by the same `motion` in the map frame.
  void MoveNodes(int first, const SE2& motion);

  /// Adds closures and optimises. While some closure, old or new, has a chi2 above max_chi2,
  /// removes the one with the largest chi2 and optimises again. If no new closure can stay, or if
  /// more old closures would have to go than new ones stay, restores the graph and returns false.
  /// Otherwise `removed` holds the ids of the removed closures.
  bool TryClosures(std::span<const ClosureConstraint> closures,
                   std::vector<ClosureId>* removed = nullptr);

  /// Ends the run: adds `links`, optimises to convergence, and removes closures and links with a
  /// chi2 above max_chi2, the largest first. Returns the ids of the removed ones.
  std::vector<ClosureId> Settle(std::span<const ClosureConstraint> links);

  /// The closures and links in the graph. A link has an id only if it was given one.
  std::vector<ClosureConstraint> Closures() const;

  /// Covariance of every node relative to the last one, each in its own frame.
  const std::vector<Eigen::Matrix3d>& relative_covariances() const { return covariances_; }

  /// Covariance of every node relative to the first one, each in its own frame.
  const std::vector<Eigen::Matrix3d>& map_covariances() const { return map_covariances_; }

  /// chi2 of a constraint at the present poses: e^T Omega e.
  double Chi2(const Constraint<SE2>& constraint) const;

 private:
  void AddConstraint(ClosureId id, const Constraint<SE2>& constraint);
  // Index of the closure's constraint with the largest chi2; -1 if none is above max_chi2.
  int WorstClosure() const;
  // Removes the closures with a chi2 above `limit`, in the order of their constraints.
  void RemoveAbove(double limit, std::vector<ClosureId>* removed);
  void UpdateCovariances(Optimizer<SE2>* optimizer, int relative_to);

  ClosureGraphOptions options_;
  PoseGraph<SE2> graph_;
  std::vector<ClosureId> ids_;  // of the graph's constraints, kNoClosure for those of the chain
  Optimizer<SE2> optimizer_;
  std::vector<Eigen::Matrix3d> covariances_;
  std::vector<Eigen::Matrix3d> map_covariances_;
};

}  // namespace loopgrid
