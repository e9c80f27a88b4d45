#include "frontend/log/carmen/carmen_parameters.h"

#include <cmath>
#include <numbers>

#include "backend/base/parse_number.h"

namespace loopgrid {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadiansPerDegree = kPi / 180.0;
constexpr double kFullTurn = 2.0 * kPi + 1e-6;  // with room for rounding

enum Laser : std::size_t { kFront, kRear, kOther };

struct Parameter {
  std::string_view name;
  Laser laser;
  double CarmenLaserParameters::*field;
  double smallest;
  double largest;
  bool is_mount;
};

using Fields = CarmenLaserParameters;
constexpr double kFarthestMount = 100.0;  // metres
constexpr double kFarthestRange = 1e4;    // metres

constexpr std::array<Parameter, 10> kParameters = {{
    {"robot_frontlaser_offset", kFront, &Fields::x, -kFarthestMount, kFarthestMount, true},
    {"robot_frontlaser_side_offset", kFront, &Fields::y, -kFarthestMount, kFarthestMount, true},
    {"robot_frontlaser_angular_offset", kFront, &Fields::theta, -2.0 * kPi, 2.0 * kPi, true},
    {"laser_front_laser_resolution", kFront, &Fields::resolution, 0.0, 180.0, false},
    {"robot_front_laser_max", kFront, &Fields::max_range, 0.0, kFarthestRange, false},
    {"robot_rearlaser_offset", kRear, &Fields::x, -kFarthestMount, kFarthestMount, true},
    {"robot_rearlaser_side_offset", kRear, &Fields::y, -kFarthestMount, kFarthestMount, true},
    {"robot_rearlaser_angular_offset", kRear, &Fields::theta, -2.0 * kPi, 2.0 * kPi, true},
    {"laser_rear_laser_resolution", kRear, &Fields::resolution, 0.0, 180.0, false},
    {"robot_rear_laser_max", kRear, &Fields::max_range, 0.0, kFarthestRange, false},
}};

}  // namespace

bool IsFrontLaser(CarmenTag tag) {
  return tag == CarmenTag::kFlaser || tag == CarmenTag::kRobotLaser1 ||
         tag == CarmenTag::kRawLaser1;
}

bool IsRearLaser(CarmenTag tag) {
  return tag == CarmenTag::kRlaser || tag == CarmenTag::kRobotLaser2 ||
         tag == CarmenTag::kRawLaser2;
}

CarmenParameters::CarmenParameters() { lasers_[kRear].theta = kPi; }

std::string CarmenParameters::Apply(std::string_view line, bool* known) {
  FieldCursor fields(line);
  fields.Next();
  const std::string_view name = fields.Next();
  *known = false;
  for (const Parameter& parameter : kParameters) {
    if (name != parameter.name) continue;
    *known = true;
    double value = 0.0;
    if (!fields.Next(&value) || value < parameter.smallest || value > parameter.largest) {
      return std::string(name) + " is not a number from " + std::to_string(parameter.smallest) +
             " to " + std::to_string(parameter.largest);
    }
    Fields& laser = lasers_[parameter.laser];
    laser.*parameter.field = value;
    laser.has_mount |= parameter.is_mount && value != 0.0;
  }
  return {};
}

const CarmenLaserParameters& CarmenParameters::Of(CarmenTag tag) const {
  if (IsFrontLaser(tag)) return lasers_[kFront];
  return lasers_[IsRearLaser(tag) ? kRear : kOther];
}

BeamAngles BeamAnglesOf(const CarmenLaserMessage& message,
                        const CarmenLaserParameters& parameters) {
  const BeamAngles usual = UsualBeamAngles(message.ranges.size());
  BeamAngles stated;
  if (message.has_angles) {
    stated = {message.start_angle, message.angular_resolution};
    if (stated.step == 0.0) {
      stated.step = message.field_of_view / static_cast<double>(BeamSteps(message.ranges.size()));
    }
  } else if (parameters.resolution > 0.0) {
    stated.step = parameters.resolution * kRadiansPerDegree;
    stated.first = usual.first * stated.step / usual.step;
  }
  const double span = std::abs(stated.step) * (static_cast<double>(message.ranges.size()) - 1.0);
  return stated.step != 0.0 && span <= kFullTurn ? stated : usual;
}

}  // namespace loopgrid
