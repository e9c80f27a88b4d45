#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include "frontend/log/carmen/carmen_interpreter.h"
#include "frontend/log/carmen/laser_mount.h"
#include "frontend/log/observation/log_reader.h"

namespace loopgrid {

/// Makes observations out of the lines of a CARMEN log as they arrive: after each line, Next()
/// gives out what is ready. The laser's mount is what PARAM lines state. Without them it is found
/// from the pairs of poses in the laser messages (see LaserMount), for which the first scans are
/// held back until the robot has moved. If these do not tell, the laser is in the robot's centre.
class CarmenDecoder {
 public:
  /// `name` is the log's, for messages about its lines.
  explicit CarmenDecoder(std::string name, const LogReaderOptions& options = {});

  /// Takes the next line, without its end. If it is not `terminated`, its last field may have been
  /// cut short. If it is `too_long`, its text is not read and it counts as malformed. Throws Error
  /// (kInput) `name:line: ...` in strict mode, if the line is malformed.
  void AddLine(std::string_view line, bool terminated = true, bool too_long = false);

  /// Takes note that the log broke off; `problem` begins with its name. Counts as malformed.
  void BreakOff(const std::string& problem);

  /// The log is over: scans held back so far are ready now.
  void Finish();

  /// The next observation that is ready, in the order of the log; false if there is none (yet).
  bool Next(Observation* observation);

  /// Number, from 1, of the line that the last observation from Next() stood in. For scans that
  /// were held back it is less than the number of lines taken so far, which statistics() has.
  std::int64_t observation_line() const { return observation_line_; }

  /// Whether there are scans that Next() has not given out yet.
  bool holds_scans() const { return !pending_.empty(); }

  const LogStatistics& statistics() const { return statistics_; }

 private:
  struct Pending {
    Observation observation;
    std::int64_t line = 0;
  };

  void CountProblem(const std::string& problem);
  void AddScan();
  void SettleMounts();

  std::string name_;
  LogReaderOptions options_;
  LogStatistics statistics_;
  CarmenInterpreter interpreter_;
  CarmenTag mount_of_ = CarmenTag::kOther;
  LaserMount mount_{SE2()};
  std::deque<Pending> pending_;
  std::size_t settled_ = 0;  // how many of them have their mount
  std::int64_t observation_line_ = 0;
  bool new_session_ = false;  // the next scan is the first of one
};

}  // namespace loopgrid
