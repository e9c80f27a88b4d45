#pragma once

#include <cstddef>
#include <deque>

#include "backend/base/line_reader.h"
#include "frontend/log/carmen_interpreter.h"
#include "frontend/log/laser_mount.h"
#include "frontend/log/log_reader.h"

namespace loopgrid {

/// Reads CARMEN text logs. The laser's mount is what PARAM lines state, else what the pairs of
/// poses in the laser messages prove (see LaserMount), for which the first scans are held back
/// until the robot has moved; else the robot's centre. A file that breaks off or whose gzip data do
/// gives all that comes before.
class CarmenReader : public LogReader {
 public:
  CarmenReader(LineReader lines, const LogReaderOptions& options);

  bool Next(Observation* observation) override;
  const LogStatistics& statistics() const override { return statistics_; }
  double progress() const override { return lines_.progress(); }

 private:
  bool ReadLine();
  void AddScan();
  void SettleMounts();

  LineReader lines_;
  LogReaderOptions options_;
  LogStatistics statistics_;
  CarmenInterpreter interpreter_;
  CarmenTag mount_of_ = CarmenTag::kOther;
  LaserMount mount_{SE2()};
  std::deque<Observation> pending_;
  std::size_t settled_ = 0;  // how many of them have their mount
};

}  // namespace loopgrid
