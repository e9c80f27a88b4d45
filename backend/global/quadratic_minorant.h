#pragma once

#include <Eigen/Core>

#include "backend/graph/pose_graph.h"

namespace loopgrid {

/// A lower bound of an edge's e^T Omega e, as a function of the pose matrices (R, t) of its ends:
///   alpha |r|^2 + 2 beta^T r + 2 <M, P> + a constant.
/// Here r = R_from^T (t_to - t_from) and P = R_from^T R_to are the position and the rotation of the
/// second end as seen from the first. The bound is quadratic in the matrices, whatever Omega is,
/// and equal to e^T Omega e at the present poses.
template <typename Pose>
struct QuadraticMinorant {
  static constexpr int kDim = Pose::Point::RowsAtCompileTime;

  double alpha = 0.0;
  typename Pose::Point beta = Pose::Point::Zero();
  Eigen::Matrix<double, kDim, kDim> M = Eigen::Matrix<double, kDim, kDim>::Zero();
  /// How far the bound is below e^T Omega e at the present poses. It is 0 except where translation
  /// and rotation are correlated in 3D, and where the rotational error is near half a turn in 2D.
  double slack = 0.0;
};

/// Which bound to use for a 3D rotation. The two differ only where one eigenvalue of the rotational
/// information exceeds the sum of the two others: kExact is the error itself, kConvex is a bound
/// that is convex around the present poses.
enum class MinorantOf3dRotation { kExact, kConvex };

template <typename Pose>
QuadraticMinorant<Pose> Minorize(const PoseGraph<Pose>& graph, const Constraint<Pose>& constraint,
                                 MinorantOf3dRotation kind);
template <typename Pose>
QuadraticMinorant<Pose> Minorize(const PoseGraph<Pose>& graph,
                                 const LandmarkObservation<Pose>& observation);

}  // namespace loopgrid
