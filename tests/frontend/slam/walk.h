#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "frontend/closing/closure_graph.h"
#include "frontend/closing/graph_update.h"
#include "frontend/closing/nodes.h"
#include "tests/support/rooms.h"

namespace loopgrid::test_support {

/// Nodes with their scans, for tests of classes that use them.
class Walk {
 public:
  Walk() { nodes_.graph = &graph_.graph(); }
  Walk(const Walk&) = delete;
  Walk& operator=(const Walk&) = delete;

  /// Adds a node at `step` from the last one, with standard deviations of `sigma` metres and
  /// `sigma` / 4 radians.
  void Add(const SE2& step, PointScan scan, double sigma = 0.02) {
    const double variance = sigma * sigma;
    const SE2 last = nodes_.size() > 0 ? nodes_.pose(nodes_.size() - 1) : SE2();
    graph_.AddNode(last * step, step,
                   Eigen::Vector3d(variance, variance, variance / 16.0).asDiagonal());
    scans_.push_back(std::make_unique<PointScan>(std::move(scan)));
    nodes_.scans.push_back(scans_.back().get());
  }

  /// Adds nodes at the poses `truth` with scans of `laser`. Each step is measured with the error
  /// `drift`.
  void Follow(const World& world, const std::vector<SE2>& truth, const SE2& drift = SE2(),
              const SimulatedLaser& laser = {}) {
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const SE2 step = i == 0 ? truth[0] : truth[i - 1].Inverse() * truth[i] * drift;
      Add(step, ScanFrom(world, truth[i], laser, static_cast<std::uint32_t>(i)));
    }
  }

  const Nodes& nodes() const { return nodes_; }
  ClosureGraph& graph() { return graph_; }

 private:
  ClosureGraph graph_;
  std::vector<std::unique_ptr<PointScan>> scans_;
  Nodes nodes_;
};

inline constexpr int kNodesARound = 24;

/// Rounds in DistinctiveRoom(), with 24 nodes half a metre apart in each round.
inline std::vector<SE2> RoundWalk(int nodes) {
  std::vector<SE2> poses;
  for (int i = 0; i < nodes; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kNodesARound;
    poses.emplace_back(1.9 * std::cos(angle), 1.9 * std::sin(angle),
                       angle + 0.5 * std::numbers::pi);
  }
  return poses;
}

/// Two rounds in DistinctiveRoom(), as tracking would submit them, with the true poses as odometry.
inline std::vector<NewNode> RoundNodes() {
  const std::vector<SE2> truth = RoundWalk(2 * kNodesARound);
  std::vector<NewNode> nodes;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    NewNode node;
    node.parent = static_cast<int>(i) - 1;
    node.T_parent_node = i == 0 ? truth[0] : truth[i - 1].Inverse() * truth[i];
    node.covariance = Eigen::Vector3d(4e-4, 4e-4, 4e-5).asDiagonal();
    node.timestamp = static_cast<double>(i);
    node.scan = std::make_shared<const PointScan>(
        ScanFrom(DistinctiveRoom(), truth[i], {}, static_cast<std::uint32_t>(i)));
    nodes.push_back(std::move(node));
  }
  return nodes;
}

}  // namespace loopgrid::test_support
