#pragma once

#include <cstddef>

namespace loopgrid {

/// Direction of the first beam in the laser frame and the step to the next, radians.
struct BeamAngles {
  double first = 0.0;
  double step = 0.0;
};

/// How many steps the field of view of a scan with `count` readings is divided into: an even count
/// lacks the last beam of a symmetric fan.
std::size_t BeamSteps(std::size_t count);

/// The fan that scanners with so many readings have: 180 and 181 readings step by 1 degree from
/// -90, 360 and 361 by half a degree, and so on; counts that only wider scanners have get their
/// field of view. An even count lacks the last beam of a symmetric fan: 180 readings end at +89.
BeamAngles UsualBeamAngles(std::size_t count);

}  // namespace loopgrid
