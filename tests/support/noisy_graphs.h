#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include "backend/graph/pose_graph.h"
#include "tests/support/poses.h"

namespace loopgrid::test_support {

/// A random symmetric positive definite matrix with eigenvalues from `floor` to some tens,
/// anisotropic and with correlations.
template <typename Matrix>
Matrix RandomInformationAbove(double floor, std::mt19937* random) {
  std::normal_distribution<double> normal;
  Matrix root;
  for (int i = 0; i < root.size(); ++i) root(i) = normal(*random);
  return root * root.transpose() + floor * Matrix::Identity();
}

/// A chain of random poses with some more constraints between random nodes, and landmarks that at
/// least three nodes have seen. The graph's poses and landmarks are the true ones; measurements
/// differ from them by up to `noise` in each coordinate.
template <typename Pose>
PoseGraph<Pose> RandomKnownGraph(int nodes, int closures, int landmarks, double noise,
                                 std::mt19937* random) {
  using Point = typename Pose::Point;
  constexpr double kReach = 5.0;
  PoseGraph<Pose> graph;
  for (int i = 0; i < nodes; ++i) graph.poses.push_back(RandomPose<Pose>(random, kReach));
  const auto constrain = [&](int from, int to) {
    const Pose T = graph.poses[static_cast<std::size_t>(from)].Inverse() *
                   graph.poses[static_cast<std::size_t>(to)];
    const auto error = RandomVector<typename Pose::Tangent>(random, noise);
    graph.constraints.push_back(
        {from, to, T.Boxplus(error),
         RandomInformationAbove<typename Constraint<Pose>::Information>(5.0, random)});
  };
  std::uniform_int_distribution<int> any(0, nodes - 1);
  for (int i = 1; i < nodes; ++i) i % 3 == 0 ? constrain(i, i - 1) : constrain(i - 1, i);
  for (int k = 0; k < closures; ++k) {
    const int from = any(*random);
    constrain(from, (from + 1 + any(*random) % (nodes - 1)) % nodes);
  }
  for (int i = 0; i < landmarks; ++i) {
    graph.landmarks.push_back(RandomVector<Point>(random, kReach));
    for (int node = i % nodes; node < nodes; node += std::max(1, nodes / 4)) {
      const Point seen =
          graph.poses[static_cast<std::size_t>(node)].Inverse() * graph.landmarks.back();
      graph.observations.push_back(
          {node, i, seen + RandomVector<Point>(random, noise),
           RandomInformationAbove<typename LandmarkObservation<Pose>::Information>(5.0, random)});
    }
  }
  return graph;
}

/// Sets all poses and landmarks to random ones, except held nodes.
template <typename Pose>
void Scramble(PoseGraph<Pose>* graph, std::mt19937* random) {
  const std::vector<int> held = HeldNodes(*graph, ConnectedComponents(*graph));
  for (std::size_t i = 0; i < graph->poses.size(); ++i) {
    if (std::ranges::find(held, static_cast<int>(i)) != held.end()) continue;
    graph->poses[i] = RandomPose<Pose>(random, 5.0);
  }
  for (auto& landmark : graph->landmarks) {
    landmark = RandomVector<typename Pose::Point>(random, 5.0);
  }
}

/// Nodes in a circle, each measured exactly from the one before. Along the ring the poses turn by
/// `twist` additional full turns about the vertical axis, in equal parts. In a long ring that is a
/// local minimum.
template <typename Pose>
PoseGraph<Pose> Ring(int nodes, int twist, double radius = 5.0) {
  PoseGraph<Pose> graph;
  const double step = 2.0 * std::numbers::pi / nodes;
  const auto place = [&](double angle, double heading) {
    if constexpr (Pose::kDof == 3) {
      return Pose(radius * std::sin(angle), -radius * std::cos(angle), heading);
    } else {
      return Pose(Eigen::Vector3d(radius * std::sin(angle), -radius * std::cos(angle), 0.0),
                  Eigen::Quaterniond(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ())));
    }
  };
  for (int i = 0; i < nodes; ++i) graph.poses.push_back(place(i * step, i * step));
  for (int i = 0; i < nodes; ++i) {
    const int next = (i + 1) % nodes;
    graph.constraints.push_back({i, next,
                                 graph.poses[static_cast<std::size_t>(i)].Inverse() *
                                     graph.poses[static_cast<std::size_t>(next)]});
  }
  for (int i = 0; i < nodes; ++i) {
    graph.poses[static_cast<std::size_t>(i)] = place(i * step, i * step * (1 + twist));
  }
  return graph;
}

}  // namespace loopgrid::test_support
