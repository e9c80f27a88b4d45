#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include "apps/live/online_update.h"
#include "mapping/map_files.h"
#include "tests/frontend/slam/walk.h"

namespace loopgrid::test_support {

/// The updates of an online run through DistinctiveRoom(), in which every third scan is a node.
class RoundTrip {
 public:
  static constexpr int kScansANode = 3;

  explicit RoundTrip(int scans) : poses_(RoundWalk(scans)) {
    for (const SE2& pose : poses_) {
      points_.push_back(std::make_shared<const PointScan>(ScanFrom(world_, pose, ExactLaser(180))));
    }
    MoveNodes(SE2());
  }

  int scans() const { return static_cast<int>(poses_.size()); }

  /// Moves node i by i times `drift`.
  void MoveNodes(const SE2& drift) {
    NodeStates states;
    SE2 T_map_truth;
    for (int scan = 0; scan < scans(); scan += kScansANode) {
      states.poses.push_back(T_map_truth * pose(scan));
      states.covariances.push_back(Eigen::Vector3d(4e-4, 1e-4, 1e-4).asDiagonal());
      T_map_truth = T_map_truth * drift;
    }
    nodes_ = std::make_shared<const NodeStates>(std::move(states));
  }

  OnlineUpdate Update(int scan) const {
    OnlineUpdate update;
    update.place = Place(scan);
    update.timestamp = 0.2 * scan;
    update.latency_seconds = 0.002;
    update.points = points_[static_cast<std::size_t>(scan)];
    update.tracked.scan = scan;
    update.tracked.T_map_robot = Pose(scan);
    update.tracked.covariance = Eigen::Vector3d(4e-4, 1e-4, 1e-4).asDiagonal();
    update.tracked.matched = true;
    if (scan % kScansANode == 0) update.tracked.node = scan / kScansANode;
    return update;
  }

  /// The same, and that the nodes (up to this scan's) have moved.
  OnlineUpdate UpdateWithNodes(int scan) const {
    OnlineUpdate update = Update(scan);
    const auto count = static_cast<std::size_t>(update.place.node) + 1;
    auto states = std::make_shared<NodeStates>(*nodes_);
    states->poses.resize(count);
    states->covariances.resize(count);
    update.nodes = std::move(states);
    update.tracked.optimized = true;
    return update;
  }

  ScanPlace Place(int scan) const {
    const int node = scan / kScansANode;
    return {node, pose(kScansANode * node).Inverse() * pose(scan)};
  }

  /// T_map_robot as it is now.
  SE2 Pose(int scan) const {
    const ScanPlace place = Place(scan);
    return nodes_->poses[static_cast<std::size_t>(place.node)] * place.T_node_robot;
  }

  /// The map of the first `scans` scans where they are now, drawn in one go.
  OccupancyGrid Map(int scans, const OccupancyGridOptions& options = {}) const {
    std::vector<SE2> poses;
    for (int scan = 0; scan < scans; ++scan) poses.push_back(Pose(scan));
    const auto scan_at = [this](std::size_t i) {
      return MapScan{.origin = points_[i]->T_robot_laser.translation(),
                     .hits = points_[i]->hits,
                     .no_returns = points_[i]->no_returns};
    };
    return RenderMap(poses, scan_at, options);
  }

 private:
  const SE2& pose(int scan) const { return poses_[static_cast<std::size_t>(scan)]; }

  World world_ = DistinctiveRoom();
  std::vector<SE2> poses_;  // true ones
  std::vector<std::shared_ptr<const PointScan>> points_;
  std::shared_ptr<const NodeStates> nodes_;
};

inline bool SameImage(const GreyImage& a, const GreyImage& b) {
  return a.width == b.width && a.height == b.height && a.pixels == b.pixels;
}

}  // namespace loopgrid::test_support
