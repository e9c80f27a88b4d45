#pragma once

#include <cmath>
#include <numbers>

namespace loopgrid {

/// The same angle in [-pi, pi), radians. NaN and infinities give NaN.
inline double NormalizeAngle(double angle) {
  constexpr double kPi = std::numbers::pi;
  if (angle >= -kPi && angle < kPi) return angle;
  const double turned = angle - 2.0 * kPi * std::floor((angle + kPi) / (2.0 * kPi));
  // Rounding can land exactly on +pi, or a hair below -pi.
  if (turned >= kPi) return turned - 2.0 * kPi;
  return turned < -kPi ? -kPi : turned;
}

}  // namespace loopgrid
