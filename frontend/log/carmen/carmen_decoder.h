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
/// returns the observations that are ready. The laser's mount comes from PARAM lines. Without them
/// it is found from the pairs of poses in the laser messages (see LaserMount). For this the first
/// scans are held back until the robot has moved. If the poses do not tell, the laser is taken to
/// be at the robot's centre.
class CarmenDecoder {
 public:
  /// `name` is the log's, for messages about its lines.
  explicit CarmenDecoder(std::string name, const LogReaderOptions& options = {});

  /// Takes the next line, without its end. If it is not `terminated`, its last field may have been
  /// cut short. If it is `too_long`, its text is not read and it counts as malformed. Throws Error
  /// (kInput) `name:line: ...` in strict mode, if the line is malformed.
  void AddLine(std::string_view line, bool terminated = true, bool too_long = false);

  /// Call when the log ends too early, for example in damaged gzip data. `problem` begins with the
  /// log's name. It counts as malformed.
  void BreakOff(const std::string& problem);

  /// Call at the end of the log: scans held back so far are then ready.
  void Finish();

  /// The next observation that is ready, in the order of the log; false if there is none (yet).
  bool Next(Observation* observation);

  /// Number, from 1, of the line of the last observation from Next(). For scans that were held back
  /// it is smaller than the number of lines taken so far (see statistics()).
  std::int64_t observation_line() const { return observation_line_; }

  /// Whether there are scans that Next() has not returned yet.
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
