#pragma once

#include <cmath>
#include <numbers>

namespace loopgrid {

/// The same angle in [-pi, pi), radians. NaN and infinities give NaN.
inline double NormalizeAngle(double angle) {
  constexpr double kPi = std::numbers::pi;
  if (angle >= -kPi && angle < kPi) return angle;
  const double turned = std::remainder(angle, 2.0 * kPi);  // exact, in [-pi, pi]
  return turned >= kPi ? -kPi : turned;
}

}  // namespace loopgrid
