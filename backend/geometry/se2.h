#pragma once

#include <Eigen/Core>
#include <cmath>

#include "backend/geometry/angle.h"

namespace loopgrid {

/// A rigid motion of the plane: rotation by theta, then translation by (x, y). `T_a_b` maps
/// coordinates in b into a, so `p_a = T_a_b * p_b` and `T_a_c = T_a_b * T_b_c`.
/// Metres and radians; theta stays in [-pi, pi).
class SE2 {
 public:
  static constexpr int kDof = 3;
  using Tangent = Eigen::Vector3d;  ///< (x, y, theta)
  using Point = Eigen::Vector2d;

  SE2() = default;
  SE2(double x, double y, double theta)
      : x_(x), y_(y), theta_(NormalizeAngle(theta)), c_(std::cos(theta_)), s_(std::sin(theta_)) {}
  explicit SE2(const Eigen::Vector3d& coordinates)
      : SE2(coordinates.x(), coordinates.y(), coordinates.z()) {}

  double x() const { return x_; }
  double y() const { return y_; }
  double theta() const { return theta_; }
  double cos() const { return c_; }
  double sin() const { return s_; }

  Eigen::Vector2d translation() const { return {x_, y_}; }
  Eigen::Matrix2d rotation() const { return (Eigen::Matrix2d() << c_, -s_, s_, c_).finished(); }
  /// (x, y, theta): the coordinates, not the logarithm.
  Eigen::Vector3d coordinates() const { return {x_, y_, theta_}; }
  bool IsFinite() const { return coordinates().allFinite(); }
  bool operator==(const SE2&) const = default;

  SE2 Inverse() const { return SE2(-c_ * x_ - s_ * y_, s_ * x_ - c_ * y_, -theta_); }

  SE2 operator*(const SE2& other) const {
    return SE2(x_ + c_ * other.x_ - s_ * other.y_, y_ + s_ * other.x_ + c_ * other.y_,
               theta_ + other.theta_);
  }

  Eigen::Vector2d operator*(const Eigen::Vector2d& p) const {
    return {x_ + c_ * p.x() - s_ * p.y(), y_ + s_ * p.x() + c_ * p.y()};
  }

  /// The pose reached from here by a small motion given in this pose's own frame:
  /// x [+] d = x * SE2(d), the boxplus of the tutorial (Section IV-C) and of g2o's VERTEX_SE2.
  SE2 Boxplus(const Tangent& d) const { return *this * SE2(d); }

  /// The d for which `origin.Boxplus(d)` is this pose.
  Tangent Boxminus(const SE2& origin) const { return (origin.Inverse() * *this).coordinates(); }

  /// The matrix with `T * SE2(d) * T.Inverse()` = `SE2(Adjoint() * d)` for small d.
  Eigen::Matrix3d Adjoint() const {
    return (Eigen::Matrix3d() << c_, -s_, y_, s_, c_, -x_, 0.0, 0.0, 1.0).finished();
  }

  /// Exponential map of a twist (vx, vy, omega).
  static SE2 Exp(const Tangent& twist);

  /// Logarithm: the twist with `Exp(Log()) == *this`.
  Tangent Log() const;

 private:
  double x_ = 0.0;
  double y_ = 0.0;
  double theta_ = 0.0;
  double c_ = 1.0;
  double s_ = 0.0;
};

namespace internal {
/// sin(t)/t and (1-cos(t))/t; the latter by way of half the angle, where nothing cancels.
inline void SinAndVersineOver(double t, double* sin_over, double* versine_over) {
  const double half_sin = std::sin(0.5 * t);
  *sin_over = std::abs(t) < 1e-8 ? 1.0 : std::sin(t) / t;
  *versine_over = std::abs(t) < 1e-8 ? 0.5 * t : 2.0 * half_sin * half_sin / t;
}
}  // namespace internal

inline SE2 SE2::Exp(const Tangent& twist) {
  double a = 1.0;
  double b = 0.0;
  internal::SinAndVersineOver(twist.z(), &a, &b);
  return SE2(a * twist.x() - b * twist.y(), b * twist.x() + a * twist.y(), twist.z());
}

inline SE2::Tangent SE2::Log() const {
  double a = 1.0;
  double b = 0.0;
  internal::SinAndVersineOver(theta_, &a, &b);
  const double scale = 1.0 / (a * a + b * b);
  return {scale * (a * x_ + b * y_), scale * (a * y_ - b * x_), theta_};
}

}  // namespace loopgrid
