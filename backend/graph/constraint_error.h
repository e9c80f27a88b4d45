#pragma once

#include <Eigen/Core>

#include "backend/graph/pose_graph.h"

namespace loopgrid {

/// The error of a constraint and its derivatives with respect to local motions of its two nodes
/// (Pose::Boxplus).
template <typename Pose>
struct LinearizedConstraint {
  using Matrix = Eigen::Matrix<double, Pose::kDof, Pose::kDof>;

  typename Pose::Tangent error;
  Matrix J_from;
  Matrix J_to;
};

/// e = T_from_to^-1 * (from^-1 * to) as (x, y, theta), theta in [-pi, pi): the error function of
/// g2o's EDGE_SE2 and equation (30) of the tutorial.
Eigen::Vector3d ConstraintError(const SE2& from, const SE2& to, const SE2& T_from_to);

/// The same as (x, y, z, vector part of the quaternion with w >= 0): that of g2o's EDGE_SE3:QUAT,
/// Section IV-C of the tutorial.
SE3::Tangent ConstraintError(const SE3& from, const SE3& to, const SE3& T_from_to);

/// With Jacobians (equation 32 of the tutorial, here for local increments).
LinearizedConstraint<SE2> Linearize(const SE2& from, const SE2& to, const SE2& T_from_to);
LinearizedConstraint<SE3> Linearize(const SE3& from, const SE3& to, const SE3& T_from_to);

/// The error of an observation and its derivatives with respect to a local motion of the node and
/// to the landmark's position.
template <typename Pose>
struct LinearizedObservation {
  using Point = typename Pose::Point;
  static constexpr int kSize = Point::RowsAtCompileTime;

  Point error;
  Eigen::Matrix<double, kSize, Pose::kDof> J_node;
  Eigen::Matrix<double, kSize, kSize> J_landmark;
};

/// e = node^-1 * landmark - p_node: the error function of g2o's EDGE_SE2_XY.
template <typename Pose>
typename Pose::Point ObservationError(const Pose& node, const typename Pose::Point& landmark,
                                      const typename Pose::Point& p_node) {
  return node.Inverse() * landmark - p_node;
}

LinearizedObservation<SE2> Linearize(const SE2& node, const Eigen::Vector2d& landmark,
                                     const Eigen::Vector2d& p_node);
LinearizedObservation<SE3> Linearize(const SE3& node, const Eigen::Vector3d& landmark,
                                     const Eigen::Vector3d& p_node);

/// e^T * Omega * e at the graph's current poses, without any robust loss.
template <typename Pose>
double Chi2(const PoseGraph<Pose>& graph, const Constraint<Pose>& constraint);
template <typename Pose>
double Chi2(const PoseGraph<Pose>& graph, const LandmarkObservation<Pose>& observation);

/// F(x): the sum of Chi2 over all constraints and observations.
template <typename Pose>
double TotalChi2(const PoseGraph<Pose>& graph);

}  // namespace loopgrid
