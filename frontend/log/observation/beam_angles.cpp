#include "frontend/log/observation/beam_angles.h"

#include <algorithm>
#include <numbers>

namespace loopgrid {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// The usual field of view of scanners with this number of steps between beams, radians.
double UsualFieldOfView(std::size_t steps) {
  switch (steps) {
    case 400:
      return 100.0 * kDegree;  // SICK LMS in its 100 degree mode
    case 540:
    case 1080:
      return 270.0 * kDegree;  // SICK LMS1xx, Hokuyo UTM-30LX
    case 682:
      return 682.0 * 360.0 / 1024.0 * kDegree;  // Hokuyo URG-04LX
    default:
      return 180.0 * kDegree;
  }
}

}  // namespace

std::size_t BeamSteps(std::size_t count) { return std::max<std::size_t>(count - count % 2, 1); }

BeamAngles UsualBeamAngles(std::size_t count) {
  const std::size_t steps = BeamSteps(count);
  const double field_of_view = UsualFieldOfView(steps);
  return {-0.5 * field_of_view, field_of_view / static_cast<double>(steps)};
}

}  // namespace loopgrid
