#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <vector>

#include "backend/graph/pose_graph.h"
#include "frontend/closing/closure.h"
#include "frontend/closing/graph_update.h"
#include "frontend/closing/session.h"

namespace loopgrid {

/// The graph that tracking uses. A new node is added at once, at the pose that tracking found. The
/// changes that the pipeline makes because of the node are applied a fixed number of steps of the
/// robot later. So the result does not depend on the speed of the machine.
class TrackingGraph {
 public:
  /// Updates are applied `lag` steps after their node was added.
  explicit TrackingGraph(int lag = 5) : lag_(lag) {}

  /// Adds a node at step `step` of the robot; its index.
  int Add(const NewNode& node, std::int64_t step);

  /// Whether the update of the oldest node that waits for one has to be applied at `step`.
  bool IsUpdateDue(std::int64_t step) const {
    return !waiting_.empty() && waiting_.front().due <= step;
  }

  /// Applies the update of the oldest node that waits for one. True if nodes have moved; the ids of
  /// closures that are new or changed are added to `changed`.
  bool ApplyOldest(GraphUpdate update, std::vector<ClosureId>* changed);

  /// Applies the update that ends the run; no node may be waiting.
  void ApplyLast(GraphUpdate update);

  int size() const { return static_cast<int>(graph_.poses.size()); }
  int waiting() const { return static_cast<int>(waiting_.size()); }  ///< nodes without their update
  const PoseGraph<SE2>& graph() const { return graph_; }
  const SE2& pose(int node) const { return graph_.poses[static_cast<std::size_t>(node)]; }

  /// Covariance of a node relative to the first one, in its own frame.
  const Eigen::Matrix3d& covariance(int node) const {
    return map_covariances_[static_cast<std::size_t>(node)];
  }

  /// Covariance of every node relative to the last node, as of the last optimisation.
  const std::vector<Eigen::Matrix3d>& relative_covariances() const { return relative_covariances_; }

  const std::vector<Closure>& closures() const { return closures_; }
  int newest_closed() const { return newest_closed_; }  ///< newest node with an accepted closure
  const Session& session() const { return session_; }   ///< the latest one
  double closing_seconds() const { return closing_seconds_; }
  double optimizing_seconds() const { return optimizing_seconds_; }

 private:
  // A node whose update has not been applied yet.
  struct Waiting {
    int index = 0;
    int parent = -1;
    SE2 T_parent_node;
    Eigen::Matrix3d covariance;
    std::int64_t due = 0;
  };

  void Append(const Waiting& node);
  bool Apply(GraphUpdate update, std::vector<ClosureId>* changed);

  int lag_;
  std::deque<Waiting> waiting_;
  PoseGraph<SE2> graph_;  // as of the last update, with the waiting nodes added
  std::vector<Eigen::Matrix3d> map_covariances_;
  std::vector<Eigen::Matrix3d> relative_covariances_;
  std::vector<Closure> closures_;
  int newest_closed_ = -1;
  Session session_;
  double closing_seconds_ = 0.0;
  double optimizing_seconds_ = 0.0;
};

}  // namespace loopgrid
