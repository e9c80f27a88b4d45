#include "backend/graph/parametrization.h"

#include <Eigen/LU>

#include "backend/geometry/euler.h"

namespace loopgrid {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Derivative of the local motion (Boxplus) by an increment of another parametrization, at zero.
Eigen::Matrix3d MotionByIncrement(const SE2& pose, Parametrization parametrization) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  if (parametrization == Parametrization::kEuler) {
    J.topLeftCorner<2, 2>() = pose.rotation().transpose();
  }
  return J;
}

Matrix6 MotionByIncrement(const SE3& pose, Parametrization parametrization) {
  Matrix6 J = Matrix6::Identity();
  if (parametrization == Parametrization::kEuler) {
    J.topLeftCorner<3, 3>() = pose.rotation().transpose();
    J.bottomRightCorner<3, 3>() = 0.5 * BodyRates(RollPitchYaw(pose.quaternion()));
  } else {
    J.bottomRightCorner<3, 3>() *= 0.5;  // the vector part of a quaternion is half the angle
  }
  return J;
}

/// The error in half Euler angles, from the vector part of a quaternion.
SE3::Tangent EulerError(const SE3::Tangent& error) {
  SE3::Tangent result = error;
  result.tail<3>() = 0.5 * RollPitchYaw(SE3(error).quaternion());
  return result;
}

/// Its derivative.
Matrix6 EulerErrorByError(const SE3::Tangent& error) {
  const Eigen::Quaterniond q = SE3(error).quaternion();
  const Eigen::Matrix3d error_by_motion = q.w() * Eigen::Matrix3d::Identity() + Skew(q.vec());
  Matrix6 J = Matrix6::Identity();
  J.bottomRightCorner<3, 3>() = BodyRates(RollPitchYaw(q)).inverse() * error_by_motion.inverse();
  return J;
}

SE2 AddCoordinates(const SE2& pose, const SE2::Tangent& d) { return SE2(pose.coordinates() + d); }

SE3 AddCoordinates(const SE3& pose, const SE3::Tangent& d) {
  return SE3(pose.translation() + d.head<3>(),
             FromRollPitchYaw(RollPitchYaw(pose.quaternion()) + d.tail<3>()));
}

}  // namespace

template <typename Pose>
Pose Increment(const Pose& pose, const typename Pose::Tangent& d, Parametrization parametrization) {
  switch (parametrization) {
    case Parametrization::kExponential:
      return pose * Pose::Exp(d);
    case Parametrization::kEuler:
      return AddCoordinates(pose, d);
    case Parametrization::kManifold:
      break;
  }
  return pose.Boxplus(d);
}

template <typename Pose>
typename Pose::Tangent ConstraintError(const Pose& from, const Pose& to, const Pose& T_from_to,
                                       Parametrization parametrization) {
  const typename Pose::Tangent error = ConstraintError(from, to, T_from_to);
  if constexpr (Pose::kDof == 6) {
    if (parametrization == Parametrization::kEuler) return EulerError(error);
  }
  return error;
}

template <typename Pose>
LinearizedConstraint<Pose> Linearize(const Pose& from, const Pose& to, const Pose& T_from_to,
                                     Parametrization parametrization) {
  LinearizedConstraint<Pose> linear = Linearize(from, to, T_from_to);
  if (parametrization == Parametrization::kManifold) return linear;
  linear.J_from *= MotionByIncrement(from, parametrization);
  linear.J_to *= MotionByIncrement(to, parametrization);
  if constexpr (Pose::kDof == 6) {
    if (parametrization == Parametrization::kEuler) {
      const Matrix6 J = EulerErrorByError(linear.error);
      linear.J_from = J * linear.J_from;
      linear.J_to = J * linear.J_to;
      linear.error = EulerError(linear.error);
    }
  }
  return linear;
}

template <typename Pose>
LinearizedObservation<Pose> Linearize(const Pose& node, const typename Pose::Point& landmark,
                                      const typename Pose::Point& p_node,
                                      Parametrization parametrization) {
  LinearizedObservation<Pose> linear = Linearize(node, landmark, p_node);
  if (parametrization != Parametrization::kManifold) {
    linear.J_node *= MotionByIncrement(node, parametrization);
  }
  return linear;
}

#define LOOPGRID_INSTANTIATE(Pose)                                                                \
  template Pose Increment(const Pose&, const Pose::Tangent&, Parametrization);                    \
  template Pose::Tangent ConstraintError(const Pose&, const Pose&, const Pose&, Parametrization); \
  template LinearizedConstraint<Pose> Linearize(const Pose&, const Pose&, const Pose&,            \
                                                Parametrization);                                 \
  template LinearizedObservation<Pose> Linearize(const Pose&, const Pose::Point&,                 \
                                                 const Pose::Point&, Parametrization);
LOOPGRID_INSTANTIATE(SE2)
LOOPGRID_INSTANTIATE(SE3)
#undef LOOPGRID_INSTANTIATE

}  // namespace loopgrid
