#pragma once

#include "backend/graph/constraint_error.h"

namespace loopgrid {

/// What the increments are that an optimiser computes, and with them the coordinates of the errors.
enum class Parametrization {
  /// Motions in the pose's own frame (Pose::Boxplus): the tutorial's Algorithm 2.
  kManifold,
  /// The same by the exponential map (Pose::Exp): angles in radians in 3D, too.
  kExponential,
  /// Additions to (x, y, theta) or (x, y, z, roll, pitch, yaw), as if space were Euclidean: the
  /// tutorial's Algorithm 1, for comparison. Rotational errors in 3D are half of roll, pitch and
  /// yaw, so that information matrices keep their meaning and small errors their values.
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
