#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/graphs.h"

namespace loopgrid::test_support {

/// A robot drives on a sphere in rings from south to north, as in Section V of the tutorial.
/// Constraints join each node to the one before and to its neighbour on the ring before. The poses
/// are from odometry. `sigma` is the standard deviation of the noise, metres and radians.
inline PoseGraph<SE3> SphereWorld(int rings, int nodes_a_ring, double sigma, unsigned seed) {
  constexpr double kRadius = 10.0;
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<SE3> truth;
  PoseGraph<SE3> graph;
  const auto measure = [&](int from, int to) {
    Constraint<SE3> c;
    c.from = from;
    c.to = to;
    SE3::Tangent noise;
    for (int i = 0; i < 6; ++i) noise(i) = (i < 3 ? sigma : 0.5 * sigma) * normal(random);
    c.T_from_to =
        (truth[static_cast<std::size_t>(from)].Inverse() * truth[static_cast<std::size_t>(to)])
            .Boxplus(noise);
    c.information.diagonal().head<3>().setConstant(1.0 / (sigma * sigma));
    c.information.diagonal().tail<3>().setConstant(4.0 / (sigma * sigma));
    graph.constraints.push_back(c);
  };
  for (int node = 0; node < rings * nodes_a_ring; ++node) {
    const double turns = static_cast<double>(node) / nodes_a_ring;
    const double latitude = std::numbers::pi * ((turns + 0.5) / (rings + 1) - 0.5);
    const Eigen::Quaterniond q =
        Eigen::AngleAxisd(2.0 * std::numbers::pi * turns, Eigen::Vector3d::UnitZ()) *
        Eigen::AngleAxisd(-latitude, Eigen::Vector3d::UnitY());
    truth.emplace_back(q * Eigen::Vector3d(kRadius, 0.0, 0.0), q);
    if (node == 0) {
      graph.poses = truth;
      continue;
    }
    measure(node - 1, node);
    graph.poses.push_back(graph.poses.back() * graph.constraints.back().T_from_to);
    if (node >= nodes_a_ring) measure(node - nodes_a_ring, node);
  }
  return graph;
}

}  // namespace loopgrid::test_support
