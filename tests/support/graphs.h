#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include "backend/constraint_error.h"
#include "backend/pose_graph.h"

namespace loopgrid::test_support {

/// A symmetric positive definite matrix with a condition number up to about 1000.
inline Eigen::Matrix3d RandomInformation(std::mt19937* random) {
  std::normal_distribution<double> normal;
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i) = normal(*random);
  return 50.0 * (root * root.transpose() + 0.1 * Eigen::Matrix3d::Identity());
}

/// A constraint between two nodes: their true relative pose with noise as small as it says.
inline Constraint<SE2> NoisyConstraint(const std::vector<SE2>& truth, int from, int to,
                                       std::mt19937* random) {
  std::normal_distribution<double> normal;
  Constraint<SE2> constraint;
  constraint.from = from;
  constraint.to = to;
  constraint.information = RandomInformation(random);
  const Eigen::Vector3d noise = constraint.information.llt().matrixU().solve(
      Eigen::Vector3d(normal(*random), normal(*random), normal(*random)));
  constraint.T_from_to =
      (truth[static_cast<std::size_t>(from)].Inverse() * truth[static_cast<std::size_t>(to)])
          .Boxplus(0.2 * noise);
  return constraint;
}

/// A robot walks in a room: `nodes` nodes in sequence, `closures` more constraints between any two
/// of them, poses from the sequence alone.
inline PoseGraph<SE2> RandomGraph(int nodes, int closures, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> turn(-1.0, 1.0);
  std::vector<SE2> truth = {SE2(2.0, -1.0, 0.5)};
  PoseGraph<SE2> graph;
  graph.poses = truth;
  for (int i = 1; i < nodes; ++i) {
    truth.push_back(truth.back() * SE2(1.0, 0.2 * turn(random), turn(random)));
    graph.constraints.push_back(NoisyConstraint(truth, i - 1, i, &random));
    graph.poses.push_back(graph.poses.back() * graph.constraints.back().T_from_to);
  }
  std::uniform_int_distribution<int> any(0, nodes - 1);
  while (closures > 0) {
    const int from = any(random);
    const int to = any(random);
    if (from == to) continue;
    graph.constraints.push_back(NoisyConstraint(truth, from, to, &random));
    --closures;
  }
  return graph;
}

/// One hub with `leaves` nodes around it, each joined to the hub alone; the hub is the last node.
inline PoseGraph<SE2> StarGraph(int leaves) {
  PoseGraph<SE2> graph;
  for (int i = 0; i < leaves; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / leaves;
    graph.poses.emplace_back(std::cos(angle), std::sin(angle), angle);
    graph.constraints.push_back({leaves, i, SE2(1.0, 0.1, angle), Eigen::Matrix3d::Identity()});
  }
  graph.poses.emplace_back(0.1, 0.2, 0.3);
  return graph;
}

/// The Hessian of F over all nodes, dense, summed up as the tutorial writes it.
inline Eigen::MatrixXd DenseHessian(const PoseGraph<SE2>& graph) {
  const auto size = static_cast<Eigen::Index>(3 * graph.poses.size());
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(size, size);
  for (const Constraint<SE2>& constraint : graph.constraints) {
    const LinearizedConstraint<SE2> linear =
        Linearize(graph.poses[static_cast<std::size_t>(constraint.from)],
                  graph.poses[static_cast<std::size_t>(constraint.to)], constraint.T_from_to);
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, size);
    J.middleCols<3>(3 * constraint.from) = linear.J_from;
    J.middleCols<3>(3 * constraint.to) = linear.J_to;
    H += J.transpose() * constraint.information * J;
  }
  return H;
}

/// The inverse of a matrix without the rows and columns of some nodes, zero in their place;
/// computed with a few more digits than double has.
inline Eigen::MatrixXd InverseWithout(const Eigen::MatrixXd& H, const std::vector<int>& nodes) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < H.rows(); ++i) {
    if (std::find(nodes.begin(), nodes.end(), i / 3) == nodes.end()) kept.push_back(i);
  }
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(H.rows(), H.cols());
  using Extended = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const Extended reduced = Eigen::MatrixXd(H(kept, kept)).cast<long double>();
  const Eigen::MatrixXd inverse = Extended(reduced.inverse()).cast<double>();
  full(kept, kept) = inverse;
  return full;
}

}  // namespace loopgrid::test_support
