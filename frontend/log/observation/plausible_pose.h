#pragma once

#include <cmath>

namespace loopgrid {

/// Whether a pose from a file is plausible: finite, within ten thousand kilometres of the origin,
/// and with an angle of at most 1e5 radians, which keeps enough digits. Metres and radians.
inline bool IsPlausiblePose(double x, double y, double theta) {
  constexpr double kFarthest = 1e7;
  constexpr double kMostTurned = 1e5;
  return std::abs(x) <= kFarthest && std::abs(y) <= kFarthest && std::abs(theta) <= kMostTurned;
}

}  // namespace loopgrid
