#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "backend/graph/pose_graph.h"
#include "frontend/matching/point_scan.h"

namespace loopgrid {

/// Where a scan is in the graph.
struct ScanPlace {
  int node = 0;  ///< the node it belongs to
  SE2 T_node_robot;
};

/// What is kept of a scan.
struct ScanEntry {
  double timestamp = 0.0;                   ///< seconds
  SE2 T_odom_robot;                         ///< as in the log
  SE2 T_robot_laser;                        ///< where the laser sits
  ScanPlace place;                          ///< in the graph
  std::shared_ptr<const PointScan> points;  ///< null if the map does not need them
};

/// All scans of a run with their places, and which of them are nodes.
class ScanTrail {
 public:
  int size() const { return static_cast<int>(scans_.size()); }
  const ScanEntry& operator[](int scan) const { return scans_[static_cast<std::size_t>(scan)]; }
  const ScanEntry& back() const { return scans_.back(); }
  ScanEntry& back() { return scans_.back(); }
  const std::vector<int>& node_scans() const { return node_scans_; }

  void Add(ScanEntry scan) { scans_.push_back(std::move(scan)); }

  /// Makes a node of the latest scan. The scans from `first_scan` on that belong to `parent` were
  /// taken on the path from there to the new node; `T_parent_node` is the pose of the new node in
  /// `parent` as tracked.
  void AddNode(int parent, const SE2& T_parent_node, int first_scan);

  const PointScan* NodePoints(int node) const {
    return (*this)[node_scans_[static_cast<std::size_t>(node)]].points.get();
  }

  /// Pose of a scan, from the pose of its node. If `graph` has changed the pose of the next node
  /// relative to this one, the change is distributed evenly over the scans between them.
  SE2 Pose(int scan, const PoseGraph<SE2>& graph) const;

 private:
  // The path to a node.
  struct Way {
    int parent = -1;
    SE2 T_parent_node;
    int first_scan = 0;
  };

  std::deque<ScanEntry> scans_;
  std::vector<int> node_scans_;
  std::vector<Way> ways_;  // to each node
};

}  // namespace loopgrid
