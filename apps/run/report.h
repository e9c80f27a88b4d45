#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "apps/settings/run_options.h"
#include "frontend/log/observation/log_reader.h"
#include "frontend/slam/slam.h"

namespace loopgrid {

/// Everything that a run reports, as plain values.
struct RunReport {
  RunOptions options;
  LogStatistics log;
  SlamStatistics slam;
  int nodes = 0;
  int constraints = 0;
  std::map<std::string, std::int64_t> closures;  ///< number of closures with each outcome
  int map_width = 0;                             ///< cells; 0 if there is no map
  int map_height = 0;                            ///< cells
  double map_resolution = 0.0;                   ///< side of a cell, metres
  double data_seconds = 0.0;                     ///< how long the recording took
  double reading_seconds = 0.0;                  ///< of the log
  double drawing_seconds = 0.0;                  ///< map and drawings
  double writing_seconds = 0.0;                  ///< the other files
  double total_seconds = 0.0;                    ///< wall time of the whole run
  double peak_memory_mb = 0.0;
  std::vector<std::string> notes;  ///< what is missing in the pictures, and why
};

/// Adds up the seconds of a recording from its time stamps, which may run backwards and jump. Steps
/// of over a minute are not counted: the clock was set.
class RecordingClock {
 public:
  void Add(double timestamp);
  double seconds() const;

 private:
  bool started_ = false;
  double last_ = 0.0;
  double sum_ = 0.0;
};

/// report.json. All that may differ between two runs on the same input is under the key "timings".
std::string FormatReportJson(const RunReport& report);

/// The few lines for the terminal.
std::string FormatSummary(const RunReport& report);

}  // namespace loopgrid
