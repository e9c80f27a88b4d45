#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace loopgrid {

/// The cross product as a matrix: `Skew(a) * b = a x b`.
inline Eigen::Matrix3d Skew(const Eigen::Vector3d& a) {
  return (Eigen::Matrix3d() << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0)
      .finished();
}

/// A rigid motion of space: rotation by a unit quaternion, then translation. `T_a_b` maps
/// coordinates in b into a, so `p_a = T_a_b * p_b` and `T_a_c = T_a_b * T_b_c`. Metres; of the two
/// quaternions of a rotation it has the one with w >= 0.
class SE3 {
 public:
  static constexpr int kDof = 6;
  /// (x, y, z, then the vector part of the quaternion, which for small angles is half the angle)
  using Tangent = Eigen::Matrix<double, 6, 1>;
  using Point = Eigen::Vector3d;

  SE3() = default;
  /// Normalises the quaternion, which must not be zero.
  SE3(const Eigen::Vector3d& translation, const Eigen::Quaterniond& rotation)
      : translation_(translation), rotation_(rotation) {
    Normalize();
  }
  /// From (x, y, z, qx, qy, qz); w is chosen so that the quaternion has length 1. A vector part
  /// longer than 1, which no unit quaternion has, gives half a turn about its direction.
  explicit SE3(const Tangent& coordinates) : translation_(coordinates.head<3>()) {
    const double squared = coordinates.tail<3>().squaredNorm();
    rotation_.vec() = coordinates.tail<3>();
    rotation_.w() = std::sqrt(std::max(0.0, 1.0 - squared));
    if (squared > 1.0) rotation_.vec() /= std::sqrt(squared);
  }

  const Eigen::Vector3d& translation() const { return translation_; }
  const Eigen::Quaterniond& quaternion() const { return rotation_; }
  Eigen::Matrix3d rotation() const { return rotation_.toRotationMatrix(); }
  /// (x, y, z, qx, qy, qz): the coordinates, not the logarithm.
  Tangent coordinates() const { return (Tangent() << translation_, rotation_.vec()).finished(); }
  bool IsFinite() const { return translation_.allFinite() && rotation_.coeffs().allFinite(); }
  bool operator==(const SE3&) const = default;

  SE3 Inverse() const {
    const Eigen::Quaterniond inverse = rotation_.conjugate();
    return SE3(-(inverse * translation_), inverse);
  }

  SE3 operator*(const SE3& other) const {
    return SE3(translation_ + rotation_ * other.translation_, rotation_ * other.rotation_);
  }

  Point operator*(const Point& p) const { return translation_ + rotation_ * p; }

  /// The pose reached from here by a small motion given in this pose's own frame:
  /// x [+] d = x * SE3(d), equation (43) of the tutorial and g2o's VERTEX_SE3:QUAT.
  SE3 Boxplus(const Tangent& d) const { return *this * SE3(d); }

  /// The d for which `origin.Boxplus(d)` is this pose.
  Tangent Boxminus(const SE3& origin) const { return (origin.Inverse() * *this).coordinates(); }

  /// The matrix with `T * SE3(d) * T.Inverse()` = `SE3(Adjoint() * d)` for small d.
  Eigen::Matrix<double, 6, 6> Adjoint() const;

  /// Exponential map of a twist (v, omega), omega being a rotation vector in radians.
  static SE3 Exp(const Tangent& twist);

  /// Logarithm: the twist, of an angle up to pi, with `Exp(Log()) == *this`.
  Tangent Log() const;

 private:
  /// Leaves a quaternion whose length is 1 up to rounding as it is, so that writing a pose to a
  /// file and reading it again changes no bit.
  void Normalize() {
    constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();
    const double squared = rotation_.squaredNorm();
    if (!(std::abs(squared - 1.0) <= kRounding)) rotation_.coeffs() /= std::sqrt(squared);
    if (rotation_.w() < 0.0) rotation_.coeffs() *= -1.0;
  }

  Eigen::Vector3d translation_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
};

inline Eigen::Matrix<double, 6, 6> SE3::Adjoint() const {
  const Eigen::Matrix3d R = rotation();
  Eigen::Matrix<double, 6, 6> adjoint;
  adjoint << R, 2.0 * Skew(translation_) * R, Eigen::Matrix3d::Zero(), R;
  return adjoint;
}

namespace internal {
/// (1 - cos(t))/t^2 and (t - sin(t))/t^3, with their series near zero.
inline void VersineAndRestOver(double t, double* versine_over, double* rest_over) {
  const double t2 = t * t;
  if (t < 1e-2) {
    *versine_over = 0.5 - t2 / 24.0 + t2 * t2 / 720.0;
    *rest_over = 1.0 / 6.0 - t2 / 120.0 + t2 * t2 / 5040.0;
  } else {
    *versine_over = (1.0 - std::cos(t)) / t2;
    *rest_over = (t - std::sin(t)) / (t2 * t);
  }
}

/// The left Jacobian of rotations, which takes v of a twist to the translation.
inline Eigen::Matrix3d TwistToTranslation(const Eigen::Vector3d& omega) {
  double a = 0.0;
  double b = 0.0;
  VersineAndRestOver(omega.norm(), &a, &b);
  const Eigen::Matrix3d W = Skew(omega);
  return Eigen::Matrix3d::Identity() + a * W + b * W * W;
}
}  // namespace internal

inline SE3 SE3::Exp(const Tangent& twist) {
  const Eigen::Vector3d omega = twist.tail<3>();
  const double angle = omega.norm();
  const double half_sin_over = angle < 1e-6 ? 0.5 : std::sin(0.5 * angle) / angle;
  Eigen::Quaterniond rotation;
  rotation.w() = std::cos(0.5 * angle);
  rotation.vec() = half_sin_over * omega;
  return SE3(internal::TwistToTranslation(omega) * twist.head<3>(), rotation);
}

inline SE3::Tangent SE3::Log() const {
  const double sine = rotation_.vec().norm();
  const double angle_over_sine = sine < 1e-8 ? 2.0 : 2.0 * std::atan2(sine, rotation_.w()) / sine;
  const Eigen::Vector3d omega = angle_over_sine * rotation_.vec();
  const Eigen::Matrix3d V = internal::TwistToTranslation(omega);
  return (Tangent() << V.inverse() * translation_, omega).finished();
}

}  // namespace loopgrid
