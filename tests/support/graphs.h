#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include "backend/graph/pose_graph.h"
#include "backend/solve/normal_equations.h"
#include "tests/support/poses.h"

namespace loopgrid::test_support {

/// A symmetric positive definite matrix with a condition number of up to some thousands.
template <int kSize>
Eigen::Matrix<double, kSize, kSize> RandomInformation(std::mt19937* random) {
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  std::normal_distribution<double> normal;
  Matrix root;
  for (int i = 0; i < root.size(); ++i) root(i) = normal(*random);
  return 50.0 * (root * root.transpose() + 0.1 * Matrix::Identity());
}

/// Noise with a fifth of the standard deviations of the information matrix.
template <int kSize>
Eigen::Matrix<double, kSize, 1> RandomNoise(const Eigen::Matrix<double, kSize, kSize>& information,
                                            std::mt19937* random) {
  std::normal_distribution<double> normal;
  Eigen::Matrix<double, kSize, 1> white;
  for (int i = 0; i < kSize; ++i) white(i) = 0.2 * normal(*random);
  return information.llt().matrixU().solve(white);
}

/// A constraint between two nodes: their true relative pose with noise.
template <typename Pose>
Constraint<Pose> NoisyConstraint(const std::vector<Pose>& truth, int from, int to,
                                 std::mt19937* random) {
  Constraint<Pose> constraint;
  constraint.from = from;
  constraint.to = to;
  constraint.information = RandomInformation<Pose::kDof>(random);
  constraint.T_from_to =
      (truth[static_cast<std::size_t>(from)].Inverse() * truth[static_cast<std::size_t>(to)])
          .Boxplus(RandomNoise(constraint.information, random));
  return constraint;
}

/// Adds landmarks near the robot's path, each seen from one to four nodes.
template <typename Pose>
void AddLandmarks(const std::vector<Pose>& truth, int landmarks, std::mt19937* random,
                  PoseGraph<Pose>* graph) {
  using Point = typename Pose::Point;
  std::uniform_int_distribution<std::size_t> any(0, truth.size() - 1);
  for (int landmark = 0; landmark < landmarks; ++landmark) {
    const Point p_map = truth[any(*random)] * RandomVector<Point>(random, 4.0);
    for (int k = 0; k <= landmark % 4; ++k) {
      LandmarkObservation<Pose> observation;
      observation.node = static_cast<int>(any(*random));
      observation.landmark = landmark;
      observation.information = RandomInformation<Point::RowsAtCompileTime>(random);
      observation.p_node = truth[static_cast<std::size_t>(observation.node)].Inverse() * p_map +
                           RandomNoise(observation.information, random);
      graph->observations.push_back(observation);
    }
    const LandmarkObservation<Pose>& last = graph->observations.back();
    graph->landmarks.push_back(graph->poses[static_cast<std::size_t>(last.node)] * last.p_node);
  }
}

/// A random walk: `nodes` nodes in sequence, `closures` more constraints between random nodes, and
/// landmarks beside the path. The poses follow from the sequence alone.
template <typename Pose = SE2>
PoseGraph<Pose> RandomGraph(int nodes, int closures, unsigned seed, int landmarks = 0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> turn(-1.0, 1.0);
  std::vector<Pose> truth = {RandomPose<Pose>(&random, 2.0)};
  PoseGraph<Pose> graph;
  graph.poses = truth;
  for (int i = 1; i < nodes; ++i) {
    typename Pose::Point step = RandomVector<typename Pose::Point>(&random, 0.2);
    step.x() = 1.0;
    truth.push_back(truth.back() * PoseWithAngle<Pose>(step, turn(random), &random));
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
  AddLandmarks(truth, landmarks, &random, &graph);
  return graph;
}

/// Two graphs as one with (at least) two components.
template <typename Pose>
PoseGraph<Pose> Union(const PoseGraph<Pose>& a, const PoseGraph<Pose>& b) {
  PoseGraph<Pose> both = a;
  const int nodes = static_cast<int>(a.poses.size());
  const int landmarks = static_cast<int>(a.landmarks.size());
  both.poses.insert(both.poses.end(), b.poses.begin(), b.poses.end());
  both.landmarks.insert(both.landmarks.end(), b.landmarks.begin(), b.landmarks.end());
  for (Constraint<Pose> constraint : b.constraints) {
    constraint.from += nodes;
    constraint.to += nodes;
    both.constraints.push_back(constraint);
  }
  for (LandmarkObservation<Pose> observation : b.observations) {
    observation.node += nodes;
    observation.landmark += landmarks;
    both.observations.push_back(observation);
  }
  return both;
}

/// `graph` is the beginning of `whole`. Appends the next node of `whole`, its constraints to nodes
/// in `graph`, and the landmarks up to the last one that it sees. Some of these may be without an
/// observation so far.
template <typename Pose>
void AppendNextNode(const PoseGraph<Pose>& whole, PoseGraph<Pose>* graph) {
  const int node = static_cast<int>(graph->poses.size());
  graph->poses.push_back(whole.poses[graph->poses.size()]);
  for (const Constraint<Pose>& c : whole.constraints) {
    if (std::max(c.from, c.to) == node) graph->constraints.push_back(c);
  }
  for (const LandmarkObservation<Pose>& o : whole.observations) {
    if (o.node != node) continue;
    graph->observations.push_back(o);
    for (std::size_t i = graph->landmarks.size(); i <= static_cast<std::size_t>(o.landmark); ++i) {
      graph->landmarks.push_back(whole.landmarks[i]);
    }
  }
}

/// One hub with `leaves` nodes around it, each joined to the hub alone; the hub is the last node.
template <typename Pose = SE2>
PoseGraph<Pose> StarGraph(int leaves) {
  std::mt19937 random(1);
  PoseGraph<Pose> graph;
  for (int i = 0; i < leaves; ++i) {
    Constraint<Pose> spoke;
    spoke.from = leaves;
    spoke.to = i;
    spoke.T_from_to = RandomPose<Pose>(&random, 2.0);
    graph.poses.push_back(spoke.T_from_to);
    graph.constraints.push_back(spoke);
  }
  graph.poses.push_back(RandomPose<Pose>(&random, 0.2));
  return graph;
}

/// The normal equations over all nodes, and after them all landmarks, as dense matrices.
struct DenseEquations {
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
};

/// Adds up H and b as the tutorial writes them.
template <typename Pose>
DenseEquations DenseNormalEquations(const PoseGraph<Pose>& graph, const Objective& objective = {}) {
  constexpr int kDof = Pose::kDof;
  constexpr int kPoint = Pose::Point::RowsAtCompileTime;
  const auto nodes = static_cast<Eigen::Index>(graph.poses.size());
  const auto size = kDof * nodes + kPoint * static_cast<Eigen::Index>(graph.landmarks.size());
  DenseEquations sum{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  const auto add = [&](const auto& edge, const auto& error, const Eigen::MatrixXd& J) {
    const double chi2 = error.dot(edge.information * error);
    const double weight = edge.robust ? objective.loss.Evaluate(chi2).weight : 1.0;
    sum.H += weight * J.transpose() * edge.information * J;
    sum.b += weight * J.transpose() * edge.information * error;
  };
  for (const Constraint<Pose>& c : graph.constraints) {
    const auto linear = Linearize(graph.poses[static_cast<std::size_t>(c.from)],
                                  graph.poses[static_cast<std::size_t>(c.to)], c.T_from_to,
                                  objective.parametrization);
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(kDof, size);
    J.middleCols<kDof>(kDof * c.from) = linear.J_from;
    J.middleCols<kDof>(kDof * c.to) = linear.J_to;
    add(c, linear.error, J);
  }
  for (const LandmarkObservation<Pose>& o : graph.observations) {
    const auto linear = Linearize(graph.poses[static_cast<std::size_t>(o.node)],
                                  graph.landmarks[static_cast<std::size_t>(o.landmark)], o.p_node,
                                  objective.parametrization);
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(kPoint, size);
    J.middleCols<kDof>(kDof * o.node) = linear.J_node;
    J.middleCols<kPoint>(kDof * nodes + kPoint * o.landmark) = linear.J_landmark;
    add(o, linear.error, J);
  }
  return sum;
}

template <typename Pose>
Eigen::MatrixXd DenseHessian(const PoseGraph<Pose>& graph) {
  return DenseNormalEquations(graph).H;
}

/// The inverse of a matrix without the rows and columns of some nodes (`dof` rows each), with zeros
/// in their place. Computed with a few more digits than double has.
inline Eigen::MatrixXd InverseWithout(const Eigen::MatrixXd& H, const std::vector<int>& nodes,
                                      int dof) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < H.rows(); ++i) {
    if (std::find(nodes.begin(), nodes.end(), i / dof) == nodes.end()) kept.push_back(i);
  }
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(H.rows(), H.cols());
  using Extended = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const Extended reduced = Eigen::MatrixXd(H(kept, kept)).cast<long double>();
  const Extended unit = Extended::Identity(reduced.rows(), reduced.cols());
  const Eigen::MatrixXd inverse = Extended(reduced.llt().solve(unit)).cast<double>();
  full(kept, kept) = inverse;
  return full;
}

}  // namespace loopgrid::test_support
