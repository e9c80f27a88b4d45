#include "backend/constraint_error.h"

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

LinearizedConstraint Linearize(const SE2& from, const SE2& to, const SE2& T_from_to) {
  const double dx = to.x() - from.x();
  const double dy = to.y() - from.y();
  const double px = from.cos() * dx + from.sin() * dy;  // position of `to` in `from`
  const double py = from.cos() * dy - from.sin() * dx;
  const double c = T_from_to.cos();
  const double s = T_from_to.sin();
  const double u = px - T_from_to.x();
  const double v = py - T_from_to.y();

  LinearizedConstraint result;
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

double Chi2(const PoseGraph& graph, const Constraint& constraint) {
  const Eigen::Vector3d error =
      ConstraintError(graph.poses[static_cast<std::size_t>(constraint.from)],
                      graph.poses[static_cast<std::size_t>(constraint.to)], constraint.T_from_to);
  return error.dot(constraint.information * error);
}

double TotalChi2(const PoseGraph& graph) {
  double sum = 0.0;
  for (const Constraint& constraint : graph.constraints) sum += Chi2(graph, constraint);
  return sum;
}

}  // namespace loopgrid
