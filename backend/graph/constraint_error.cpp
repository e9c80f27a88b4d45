#include "backend/graph/constraint_error.h"

#include <cstddef>

namespace loopgrid {

Eigen::Vector3d ConstraintError(const SE2& from, const SE2& to, const SE2& T_from_to) {
  // Written out: composing SE2 objects would compute six sines and cosines that are not needed.
  const double dx = to.x() - from.x();
  const double dy = to.y() - from.y();
  const double u = from.cos() * dx + from.sin() * dy - T_from_to.x();
  const double v = from.cos() * dy - from.sin() * dx - T_from_to.y();
  return {T_from_to.cos() * u + T_from_to.sin() * v, T_from_to.cos() * v - T_from_to.sin() * u,
          NormalizeAngle(to.theta() - from.theta() - T_from_to.theta())};
}

LinearizedConstraint<SE2> Linearize(const SE2& from, const SE2& to, const SE2& T_from_to) {
  const double dx = to.x() - from.x();
  const double dy = to.y() - from.y();
  const double px = from.cos() * dx + from.sin() * dy;  // position of `to` in `from`
  const double py = from.cos() * dy - from.sin() * dx;
  const double c = T_from_to.cos();
  const double s = T_from_to.sin();
  const double u = px - T_from_to.x();
  const double v = py - T_from_to.y();

  LinearizedConstraint<SE2> result;
  result.error << c * u + s * v, c * v - s * u,
      NormalizeAngle(to.theta() - from.theta() - T_from_to.theta());

  // Moving `to` by d moves the error by R_error * d; moving `from` by (t, a) moves the position of
  // `to` in `from` by -t - a * (-py, px).
  result.J_from << -c, -s, c * py - s * px,  //
      s, -c, -s * py - c * px,               //
      0.0, 0.0, -1.0;
  const double relative_cos = from.cos() * to.cos() + from.sin() * to.sin();
  const double relative_sin = from.cos() * to.sin() - from.sin() * to.cos();
  const double error_cos = c * relative_cos + s * relative_sin;
  const double error_sin = c * relative_sin - s * relative_cos;
  result.J_to << error_cos, -error_sin, 0.0,  //
      error_sin, error_cos, 0.0,              //
      0.0, 0.0, 1.0;
  return result;
}

SE3::Tangent ConstraintError(const SE3& from, const SE3& to, const SE3& T_from_to) {
  return (from.Inverse() * to).Boxminus(T_from_to);
}

LinearizedConstraint<SE3> Linearize(const SE3& from, const SE3& to, const SE3& T_from_to) {
  const SE3 T = from.Inverse() * to;
  const SE3 E = T_from_to.Inverse() * T;
  const Eigen::Matrix3d R_inverse = T_from_to.rotation().transpose();
  // The vector part of q * (v, 1) is, to first order, that of q plus (w I + [q]x) v; that of
  // (v, 1) * q has (w I - [q]x) v.
  const Eigen::Matrix3d w = E.quaternion().w() * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d q = Skew(E.quaternion().vec());

  LinearizedConstraint<SE3> result;
  result.error = E.coordinates();
  // Moving `to` by (t, v) multiplies E by it from the right. Moving `from` moves `to`, as seen from
  // there, by -t + 2 T.translation() x v, and its quaternion from the left by (-v, 1).
  result.J_from << -R_inverse, 2.0 * R_inverse * Skew(T.translation()), Eigen::Matrix3d::Zero(),
      (q - w) * R_inverse;
  result.J_to << E.rotation(), Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero(), w + q;
  return result;
}

LinearizedObservation<SE2> Linearize(const SE2& node, const Eigen::Vector2d& landmark,
                                     const Eigen::Vector2d& p_node) {
  const Eigen::Vector2d seen = node.Inverse() * landmark;
  LinearizedObservation<SE2> result;
  result.error = seen - p_node;
  result.J_node << -1.0, 0.0, seen.y(), 0.0, -1.0, -seen.x();
  result.J_landmark = node.rotation().transpose();
  return result;
}

LinearizedObservation<SE3> Linearize(const SE3& node, const Eigen::Vector3d& landmark,
                                     const Eigen::Vector3d& p_node) {
  const Eigen::Vector3d seen = node.Inverse() * landmark;
  LinearizedObservation<SE3> result;
  result.error = seen - p_node;
  result.J_node << -Eigen::Matrix3d::Identity(), 2.0 * Skew(seen);
  result.J_landmark = node.rotation().transpose();
  return result;
}

template <typename Pose>
double Chi2(const PoseGraph<Pose>& graph, const Constraint<Pose>& constraint) {
  const typename Pose::Tangent error =
      ConstraintError(graph.poses[static_cast<std::size_t>(constraint.from)],
                      graph.poses[static_cast<std::size_t>(constraint.to)], constraint.T_from_to);
  return error.dot(constraint.information * error);
}

template <typename Pose>
double Chi2(const PoseGraph<Pose>& graph, const LandmarkObservation<Pose>& observation) {
  const typename Pose::Point error = ObservationError(
      graph.poses[static_cast<std::size_t>(observation.node)],
      graph.landmarks[static_cast<std::size_t>(observation.landmark)], observation.p_node);
  return error.dot(observation.information * error);
}

template <typename Pose>
double TotalChi2(const PoseGraph<Pose>& graph) {
  double sum = 0.0;
  for (const auto& constraint : graph.constraints) sum += Chi2(graph, constraint);
  for (const auto& observation : graph.observations) sum += Chi2(graph, observation);
  return sum;
}

#define LOOPGRID_INSTANTIATE(Pose)                                                \
  template double Chi2(const PoseGraph<Pose>&, const Constraint<Pose>&);          \
  template double Chi2(const PoseGraph<Pose>&, const LandmarkObservation<Pose>&); \
  template double TotalChi2(const PoseGraph<Pose>&);
LOOPGRID_INSTANTIATE(SE2)
LOOPGRID_INSTANTIATE(SE3)
#undef LOOPGRID_INSTANTIATE

}  // namespace loopgrid
