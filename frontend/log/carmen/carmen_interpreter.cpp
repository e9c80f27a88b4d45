#include "frontend/log/carmen/carmen_interpreter.h"

namespace loopgrid {

CarmenMeaning CarmenInterpreter::Read(std::string_view line, bool terminated) {
  if (!terminated) line = WithoutCutField(line);
  const CarmenTag tag = TagOf(line);
  if (IsLaser(tag)) return ReadLaser(line);
  if (tag == CarmenTag::kOdom) return ReadOdometry(line);
  if (line == kNewSessionLine) return CarmenMeaning::kNewSession;
  if (tag != CarmenTag::kParam) return CarmenMeaning::kNothing;
  bool known = false;
  problem_ = parameters_.Apply(line, &known);
  if (!problem_.empty()) return CarmenMeaning::kMalformed;
  return known ? CarmenMeaning::kParameter : CarmenMeaning::kNothing;
}

CarmenMeaning CarmenInterpreter::ReadLaser(std::string_view line) {
  problem_ = ParseLaserLine(line, &message_);
  if (!problem_.empty()) return CarmenMeaning::kMalformed;
  if (message_.tag > used_) return CarmenMeaning::kOtherLaser;
  used_ = message_.tag;
  if (!message_.has_poses && !had_odometry_) started_at_origin_ = true;
  return CarmenMeaning::kScan;
}

Observation CarmenInterpreter::MakeObservation() const {
  const CarmenLaserParameters& parameters = parameters_.Of(message_.tag);
  const BeamAngles angles = BeamAnglesOf(message_, parameters);
  Observation observation;
  observation.timestamp = message_.timestamp;
  observation.T_odom_robot = message_.has_poses ? message_.T_odom_robot : latest_odometry_;
  observation.scan.first_angle = angles.first;
  observation.scan.angle_step = angles.step;
  observation.scan.max_range = message_.has_angles ? message_.max_range : parameters.max_range;
  observation.scan.ranges = message_.ranges;
  return observation;
}

CarmenMeaning CarmenInterpreter::ReadOdometry(std::string_view line) {
  SE2 T_odom_robot;
  problem_ = ParseOdometryLine(line, &T_odom_robot);
  if (!problem_.empty()) return CarmenMeaning::kMalformed;
  if (!had_odometry_ && started_at_origin_) T_origin_odom_ = T_odom_robot.Inverse();
  had_odometry_ = true;
  latest_odometry_ = started_at_origin_ ? T_origin_odom_ * T_odom_robot : T_odom_robot;
  return CarmenMeaning::kOdometry;
}

}  // namespace loopgrid
