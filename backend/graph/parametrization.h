#pragma once

#include "backend/graph/constraint_error.h"

namespace loopgrid {

/// The meaning of the increments that an optimiser computes. It also determines the coordinates of
/// the errors.
enum class Parametrization {
  /// Motions in the pose's own frame (Pose::Boxplus): the tutorial's Algorithm 2.
  kManifold,
  /// Motions in the pose's own frame by the exponential map (Pose::Exp). Rotations are then in
  /// radians in 3D, too.
  kExponential,
  /// Increments are added to (x, y, theta) or (x, y, z, roll, pitch, yaw) as to a vector: the
  /// tutorial's Algorithm 1, for comparison. Rotational errors in 3D are half of roll, pitch and
  /// yaw. For small rotations these are the coordinates of kManifold, so that the same information
  /// matrices can be used.
  kEuler,
};

/// The pose after an increment.
template <typename Pose>
Pose Increment(const Pose& pose, const typename Pose::Tangent& d, Parametrization parametrization);

template <typename Pose>
typename Pose::Tangent ConstraintError(const Pose& from, const Pose& to, const Pose& T_from_to,
                                       Parametrization parametrization);

/// Errors with Jacobians with respect to increments.
template <typename Pose>
LinearizedConstraint<Pose> Linearize(const Pose& from, const Pose& to, const Pose& T_from_to,
                                     Parametrization parametrization);
template <typename Pose>
LinearizedObservation<Pose> Linearize(const Pose& node, const typename Pose::Point& landmark,
                                      const typename Pose::Point& p_node,
                                      Parametrization parametrization);

}  // namespace loopgrid
