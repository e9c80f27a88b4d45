#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>

#include "apps/live/online_update.h"
#include "apps/online/source/line_queue.h"
#include "apps/run/report.h"
#include "apps/settings/run_options.h"
#include "frontend/log/carmen/carmen_decoder.h"
#include "frontend/slam/slam.h"

namespace loopgrid {

/// Maps a log line by line. Gives the result for each scan to a function, as values.
class OnlineMapper {
 public:
  using Sink = std::function<void(const OnlineUpdate&)>;

  /// `options.log` is the log's name, for messages about its lines.
  OnlineMapper(const RunOptions& options, Sink sink);

  /// Calls the sink for each scan that is ready with this line. Throws Error (kInput) in strict
  /// mode, if the line is malformed.
  void AddLine(const ReceivedLine& line);

  /// Call after the last line. Scans that were held back to find the laser's mount are mapped now.
  void End();

  Slam* slam() { return &slam_; }
  const LogStatistics& log() const { return decoder_.statistics(); }
  double data_seconds() const { return clock_.seconds(); }
  std::int64_t accepted_closures() const { return accepted_closures_; }

 private:
  void TakeScans();
  OnlineUpdate Describe(const TrackedScan& tracked, const Observation& observation);
  double SecondsSinceArrival(std::int64_t line);
  void CountAccepted(const TrackedScan& tracked);

  Sink sink_;
  CarmenDecoder decoder_;
  Slam slam_;
  RecordingClock clock_;
  // Arrival times of the latest lines, beginning with the line of the oldest scan that is held
  // back.
  std::deque<std::chrono::steady_clock::time_point> arrivals_;
  std::vector<bool> accepted_;  // of the closures
  std::int64_t accepted_closures_ = 0;
};

}  // namespace loopgrid
