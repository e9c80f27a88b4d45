#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "backend/graph/pose_graph.h"

namespace loopgrid::test_support {

/// A robot drives along the streets of a square city, with a node at each crossing. At a crossing
/// that it has visited before, constraints join the node to earlier ones (at most `closures`). The
/// poses are from odometry.
inline PoseGraph<SE2> ManhattanWorld(int nodes, int closures, unsigned seed) {
  const Eigen::Vector3d sigma(0.05, 0.05, 0.02);
  const Eigen::Matrix3d information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  const int side = std::max(2, static_cast<int>(std::sqrt(nodes / 3.0)));
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<SE2> truth;
  std::map<std::pair<int, int>, std::vector<int>> visits;
  PoseGraph<SE2> graph;
  const auto measure = [&](int from, int to) {
    const SE2 exact =
        truth[static_cast<std::size_t>(from)].Inverse() * truth[static_cast<std::size_t>(to)];
    const Eigen::Vector3d noise(normal(random), normal(random), normal(random));
    graph.constraints.push_back({from, to, exact.Boxplus(sigma.cwiseProduct(noise)), information});
  };
  int x = side / 2;
  int y = side / 2;
  int heading = 0;
  for (int node = 0; node < nodes; ++node) {
    truth.emplace_back(x, y, heading * std::numbers::pi / 2.0);
    if (node == 0) {
      graph.poses.emplace_back();
    } else {
      measure(node - 1, node);
      graph.poses.push_back(graph.poses.back() * graph.constraints.back().T_from_to);
    }
    std::vector<int>& here = visits[{x, y}];
    const auto count = std::min(here.size(), static_cast<std::size_t>(closures));
    for (std::size_t k = 0; k < count; ++k) measure(here[here.size() - 1 - k], node);
    here.push_back(node);

    constexpr int kStepX[] = {1, 0, -1, 0};
    constexpr int kStepY[] = {0, 1, 0, -1};
    if (random() % 3 == 0) heading = (heading + (random() % 2 == 0 ? 1 : 3)) % 4;
    while (x + kStepX[heading] < 0 || x + kStepX[heading] >= side || y + kStepY[heading] < 0 ||
           y + kStepY[heading] >= side) {
      heading = (heading + 1) % 4;
    }
    x += kStepX[heading];
    y += kStepY[heading];
  }
  return graph;
}

}  // namespace loopgrid::test_support
