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

/// A line that broke off without its last field, which may have been cut short.
inline std::string_view WithoutCutField(std::string_view line) {
  return line.substr(0, line.find_last_of(" \t") + 1);
}

/// What a line of a CARMEN log means for a mapper.
enum class CarmenMeaning {
  kScan,        ///< a scan of the laser in use
  kOtherLaser,  ///< a scan of a laser that is not used because a better one is there
  kOdometry,
  kParameter,
  kNewSession,  ///< kNewSessionLine
  kNothing,     ///< comments, blank lines, SYNC and all other tags
  kMalformed,
};

/// Follows a CARMEN log line by line: keeps the parameters, the latest odometry and which laser is
/// in use. That is the best one met so far in the order of CarmenTag, so a log with both lasers
/// gives the front one's scans and a log with only a rear laser gives these.
class CarmenInterpreter {
 public:
  /// Takes the next line. In one that is not `terminated` the last field may have been cut short
  /// and does not count.
  CarmenMeaning Read(std::string_view line, bool terminated);

  /// After kScan and kOtherLaser: the message.
  const CarmenLaserMessage& message() const { return message_; }

  /// After kScan: the message as an observation, but for the laser's mount. RAWLASER messages take
  /// the latest ODOM line's pose; what comes before the first of these stands at the origin.
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
