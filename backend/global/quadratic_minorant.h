#pragma once

#include <Eigen/Core>

#include "backend/graph/pose_graph.h"

namespace loopgrid {

/// A function of the pose matrices (R, t) of an edge's ends that is nowhere above the edge's
/// e^T Omega e and touches it at the present poses:
///   alpha |r|^2 + 2 beta^T r + 2 <M, P> + a constant,
/// r being the position and P = R_from^T R_to the rotation of the second end as seen from the first
/// (r = R_from^T (t_to - t_from)). It is quadratic in the matrices, whatever Omega is.
template <typename Pose>
struct QuadraticMinorant {
  static constexpr int kDim = Pose::Point::RowsAtCompileTime;

  double alpha = 0.0;
  typename Pose::Point beta = Pose::Point::Zero();
  Eigen::Matrix<double, kDim, kDim> M = Eigen::Matrix<double, kDim, kDim>::Zero();
  /// How far below e^T Omega e it is at the present poses: more than 0 where it does not touch,
  /// which is with correlated translation and rotation in 3D, and next to half a turn in 2D.
  double slack = 0.0;
};

/// There are several such functions where the rotational information is so anisotropic that one of
/// its eigenvalues exceeds the sum of the two others, in 3D: the error itself, or one that remains
/// convex around the present poses.
enum class MinorantOf3dRotation { kExact, kConvex };

template <typename Pose>
QuadraticMinorant<Pose> Minorize(const PoseGraph<Pose>& graph, const Constraint<Pose>& constraint,
                                 MinorantOf3dRotation kind);
template <typename Pose>
QuadraticMinorant<Pose> Minorize(const PoseGraph<Pose>& graph,
                                 const LandmarkObservation<Pose>& observation);

}  // namespace loopgrid
