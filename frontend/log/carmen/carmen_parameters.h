#pragma once

#include <array>
#include <string>
#include <string_view>

#include "backend/geometry/se2.h"
#include "frontend/log/carmen/carmen_line.h"
#include "frontend/log/observation/beam_angles.h"

namespace loopgrid {

/// What the PARAM lines of a CARMEN log say about one laser.
struct CarmenLaserParameters {
  double x = 0.0;           ///< robot_frontlaser_offset, metres ahead of the robot's centre
  double y = 0.0;           ///< robot_frontlaser_side_offset, metres to the left of it
  double theta = 0.0;       ///< robot_frontlaser_angular_offset, radians
  double resolution = 0.0;  ///< laser_front_laser_resolution, degrees; 0: not given
  double max_range = 0.0;   ///< robot_front_laser_max, metres; 0: not given

  bool has_mount = false;  ///< a PARAM line gave the laser's place on the robot

  SE2 T_robot_laser() const { return SE2(x, y, theta); }
};

/// Whether a message is of the front laser: FLASER, ROBOTLASER1, RAWLASER1.
bool IsFrontLaser(CarmenTag tag);

/// Whether a message is of the rear laser: RLASER, ROBOTLASER2, RAWLASER2.
bool IsRearLaser(CarmenTag tag);

/// The parameters of a CARMEN log that are about its lasers. They hold from their line on.
class CarmenParameters {
 public:
  CarmenParameters();

  /// Takes a PARAM line. `known` tells whether it is about a laser. Returns what is wrong with it,
  /// or an empty string.
  std::string Apply(std::string_view line, bool* known);

  /// The parameters of the front laser, of the rear laser (it looks backwards if no line says
  /// otherwise), or of other lasers (they have the defaults).
  const CarmenLaserParameters& Of(CarmenTag tag) const;

 private:
  std::array<CarmenLaserParameters, 3> lasers_;  // front, rear, others
};

/// The directions of a message's beams. ROBOTLASER and RAWLASER state them. For FLASER and RLASER
/// the resolution comes from PARAM if it is given there; the fan is that of UsualBeamAngles().
BeamAngles BeamAnglesOf(const CarmenLaserMessage& message, const CarmenLaserParameters& parameters);

}  // namespace loopgrid
