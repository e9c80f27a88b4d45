#pragma once

namespace loopgrid {

/// The times at which the scans of a log are played.
class ReplaySchedule {
 public:
  /// `speed` is times real time; 0: everything is due at once.
  explicit ReplaySchedule(double speed) : speed_(speed) {}

  /// Takes the time stamp of the next scan. Returns the time when it is due, in seconds from the
  /// start. The time since the scan before is that of the time stamps, divided by the speed. If the
  /// clock of the log has jumped backwards, or by more than kLongestGap, the scan is due at once.
  double Due(double timestamp);

  static constexpr double kLongestGap = 5.0;  ///< seconds by the log's clock

 private:
  double speed_;
  bool begun_ = false;
  double last_timestamp_ = 0.0;
  double due_ = 0.0;
};

}  // namespace loopgrid
