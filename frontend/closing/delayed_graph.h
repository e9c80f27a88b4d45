#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <vector>

#include "backend/graph/pose_graph.h"
#include "frontend/closing/closing_queue.h"
#include "frontend/closing/closure_record.h"

namespace loopgrid {

/// The graph as tracking sees it. A new node stands in it at once, where tracking put it. Closures
/// take time to be found and tracking does not wait for them: what they change is taken over so
/// many steps of the robot later, however fast or slow the machine is.
class DelayedGraph {
 public:
  static constexpr int kLag = 5;  ///< steps

  /// `threaded`: loops are closed on a thread of their own.
  explicit DelayedGraph(bool threaded) : closing_(threaded) {}

  /// Adds a node at step `step` of the robot; its index.
  int Add(NewNode node, std::int64_t step);

  /// Takes over what is due at `step`. True if nodes have moved; the indices of closures that are
  /// new or changed are added to `changed`.
  bool TakeDue(std::int64_t step, std::vector<int>* changed);

  /// Takes over all that is left and ends the run, see LoopClosing::Finish().
  void Finish();

  int size() const { return static_cast<int>(graph_.poses.size()); }
  const PoseGraph<SE2>& graph() const { return graph_; }
  const SE2& pose(int node) const { return graph_.poses[static_cast<std::size_t>(node)]; }

  /// Covariance of a node relative to the first one, in its own frame.
  const Eigen::Matrix3d& covariance(int node) const {
    return map_covariances_[static_cast<std::size_t>(node)];
  }

  /// As of the last optimisation: of every node relative to the last one then.
  const std::vector<Eigen::Matrix3d>& relative_covariances() const { return relative_covariances_; }

  const std::vector<ClosureRecord>& closures() const { return closures_; }
  int newest_closed() const { return newest_closed_; }  ///< newest node with an accepted closure
  int session() const { return session_; }              ///< first node of the latest session
  bool localized() const { return localized_; }         ///< whether that one has its place
  double closing_seconds() const { return closing_seconds_; }
  double optimizing_seconds() const { return optimizing_seconds_; }

 private:
  // A node of which closing has not been heard yet.
  struct Pending {
    int index = 0;
    int parent = -1;
    SE2 T_parent_node;
    Eigen::Matrix3d covariance;
    std::int64_t due = 0;
  };

  void Append(const Pending& node);
  bool TakeOldest(std::vector<int>* changed);
  bool Apply(ClosingNews news, std::vector<int>* changed);

  ClosingQueue closing_;
  std::deque<Pending> pending_;
  PoseGraph<SE2> graph_;  // as closing left it, with the pending nodes added
  std::vector<Eigen::Matrix3d> map_covariances_;
  std::vector<Eigen::Matrix3d> relative_covariances_;
  std::vector<ClosureRecord> closures_;
  int newest_closed_ = -1;
  int session_ = 0;
  bool localized_ = true;
  double closing_seconds_ = 0.0;
  double optimizing_seconds_ = 0.0;
};

}  // namespace loopgrid
