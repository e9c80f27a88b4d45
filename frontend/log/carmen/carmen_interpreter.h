#pragma once

#include <string>
#include <string_view>

#include "backend/geometry/se2.h"
#include "frontend/log/carmen/carmen_line.h"
#include "frontend/log/carmen/carmen_parameters.h"
#include "frontend/log/observation/observation.h"

namespace loopgrid {

/// The comment line that begins a session: what follows was recorded later, and the robot may have
/// been carried.
inline constexpr std::string_view kNewSessionLine = "# loopgrid new-session";

/// Returns an unfinished line without its last field, because that field may be cut short.
inline std::string_view WithoutCutField(std::string_view line) {
  return line.substr(0, line.find_last_of(" \t") + 1);
}

/// What a line of a CARMEN log means for a mapper.
enum class CarmenMeaning {
  kScan,        ///< a scan of the laser in use
  kOtherLaser,  ///< a scan of a laser that is not used because the log has a preferred one
  kOdometry,
  kParameter,
  kNewSession,  ///< kNewSessionLine
  kNothing,     ///< comments, blank lines, SYNC and all other tags
  kMalformed,
};

/// Reads a CARMEN log line by line: keeps the parameters, the latest odometry and the laser in use.
/// The laser in use is the first in the order of CarmenTag among those met so far. So a log with
/// both lasers gives the front laser's scans, and a log with only a rear laser gives the rear
/// laser's.
class CarmenInterpreter {
 public:
  /// Takes the next line. In one that is not `terminated` the last field may have been cut short
  /// and does not count.
  CarmenMeaning Read(std::string_view line, bool terminated);

  /// After kScan and kOtherLaser: the message.
  const CarmenLaserMessage& message() const { return message_; }

  /// After kScan: the message as an observation, without the laser's mount. RAWLASER messages get
  /// the pose of the latest ODOM line. Those before the first ODOM line get the pose (0, 0, 0).
  Observation MakeObservation() const;

  const CarmenParameters& parameters() const { return parameters_; }

  /// After kMalformed: what is wrong with the line.
  const std::string& problem() const { return problem_; }

 private:
  CarmenMeaning ReadLaser(std::string_view line);
  CarmenMeaning ReadOdometry(std::string_view line);

  CarmenLaserMessage message_;
  CarmenParameters parameters_;
  CarmenTag used_ = CarmenTag::kOther;
  bool had_odometry_ = false;
  bool started_at_origin_ = false;  // scans came before any odometry
  SE2 T_origin_odom_;
  SE2 latest_odometry_;
  std::string problem_;
};

}  // namespace loopgrid
