#pragma once

namespace loopgrid {

/// When the scans of a log are due if it is played.
class ReplaySchedule {
 public:
  /// `speed` is times real time; 0: everything is due at once.
  explicit ReplaySchedule(double speed) : speed_(speed) {}

  /// Takes the time stamp of the next scan. Returns when it is due, seconds from the start: as long
  /// after the scan before as the time stamps say. Where the clock of the log has jumped, backwards
  /// or by more than kLongestGap, it is due at once.
  double Due(double timestamp);

  static constexpr double kLongestGap = 5.0;  ///< seconds by the log's clock

 private:
  double speed_;
  bool begun_ = false;
  double last_timestamp_ = 0.0;
  double due_ = 0.0;
};

}  // namespace loopgrid
