#pragma once

#include <cstddef>

namespace loopgrid {

/// Direction of the first beam in the laser frame and the step to the next, radians.
struct BeamAngles {
  double first = 0.0;
  double step = 0.0;
};

/// Number of angular steps in the field of view of a scan with `count` readings. A scan with an
/// even count does not have the last beam of a symmetric fan.
std::size_t BeamSteps(std::size_t count);

/// The angles that scanners with `count` readings usually have: 180 and 181 readings begin at -90
/// degrees with steps of 1 degree, 360 and 361 with steps of half a degree, and so on. Counts of
/// wider scanners get the field of view of those. A scan with an even count does not have the last
/// beam of a symmetric fan: 180 readings end at +89.
BeamAngles UsualBeamAngles(std::size_t count);

}  // namespace loopgrid
