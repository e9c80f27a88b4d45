#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "backend/graph/pose_graph.h"
#include "backend/solve/optimizer.h"
#include "frontend/closing/closing_options.h"
#include "frontend/closing/closure.h"

namespace loopgrid {

/// A closure as the graph takes it.
struct ClosureConstraint {
  ClosureId id = kNoClosure;
  Constraint<SE2> constraint;
};

/// The pose graph as SLAM grows it: a chain of nodes, and closures that are believed only as long
/// as the rest of the graph lets them. Knows no scans.
class ClosureGraph {
 public:
  explicit ClosureGraph(const ClosureGraphOptions& options = {});

  const PoseGraph<SE2>& graph() const { return graph_; }
  int size() const { return static_cast<int>(graph_.poses.size()); }

  /// Adds a node at `T_map_node`, joined to `parent` (-1: the last one) by what `T_parent_node`
  /// (with `covariance`, frame of the new node) says. The first node takes no constraint.
  void AddNode(const SE2& T_map_node, const SE2& T_parent_node, const Eigen::Matrix3d& covariance,
               int parent = -1);

  /// Moves all nodes from `first` on by the same motion of the map frame.
  void MoveNodes(int first, const SE2& motion);

  /// Adds closures and optimises. As long as that leaves some closure, old or new, off by more than
  /// max_chi2, the worst goes out again; old ones only while fewer than the new ones that stay. If
  /// none of the new ones would stay, the graph is left as it was: false. The ids of those that
  /// went out are put into `removed`.
  bool TryClosures(std::span<const ClosureConstraint> closures,
                   std::vector<ClosureId>* removed = nullptr);

  /// Ends the run: adds `links`, optimises to convergence, and takes out closures and links that
  /// are off by more than max_chi2, the worst first. Returns the ids of those.
  std::vector<ClosureId> Settle(std::span<const ClosureConstraint> links);

  /// The closures in the graph; links have ids of their own or none.
  std::vector<ClosureConstraint> Closures() const;

  /// Covariance of every node relative to the last one, each in its own frame.
  const std::vector<Eigen::Matrix3d>& relative_covariances() const { return covariances_; }

  /// Covariance of every node relative to the first one, each in its own frame.
  const std::vector<Eigen::Matrix3d>& map_covariances() const { return map_covariances_; }

  /// chi-square e^T Omega e of a constraint at the present poses.
  double Chi2(const Constraint<SE2>& constraint) const;

 private:
  void AddConstraint(ClosureId id, const Constraint<SE2>& constraint);
  // Index of the constraint of the closure that is off the most, -1 if none is off too much.
  int WorstClosure() const;
  // Takes out the closures with a chi-square above `limit`, in the order of their constraints.
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
