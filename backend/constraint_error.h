#pragma once

#include <Eigen/Core>

#include "backend/pose_graph.h"

namespace loopgrid {

/// The error of a constraint and its derivatives with respect to local motions of its two nodes
/// (SE2::Boxplus).
struct LinearizedConstraint {
  Eigen::Vector3d error;
  Eigen::Matrix3d J_from;
  Eigen::Matrix3d J_to;
};

/// e = T_from_to^-1 * (from^-1 * to) as (x, y, theta), theta in [-pi, pi): the error function of
/// g2o's EDGE_SE2 and equation (30) of the tutorial.
Eigen::Vector3d ConstraintError(const SE2& from, const SE2& to, const SE2& T_from_to);

/// The same with its Jacobians (equation 32 of the tutorial, here for local increments).
LinearizedConstraint Linearize(const SE2& from, const SE2& to, const SE2& T_from_to);

/// e^T * Omega * e at the graph's current poses, without any robust loss.
double Chi2(const PoseGraph& graph, const Constraint& constraint);

/// F(x): the sum of Chi2 over all constraints.
double TotalChi2(const PoseGraph& graph);

}  // namespace loopgrid
