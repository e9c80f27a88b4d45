#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace loopgrid {

/// One line of progress: bar, per cent, scans and, after the first half second, rate and time left;
/// at most `width` characters. `fraction` is the share of the log that has been read, 0..1; it is 0
/// if that is not known, and the bar is then left out.
std::string FormatProgress(double fraction, std::int64_t scans, double seconds, int width);

/// A progress bar on standard error. Shows nothing if that is not a terminal.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  ~ProgressBar() { Clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Redraws the bar, at most ten times a second.
  void Update(double fraction, std::int64_t scans);

  /// Shows what the program does after the last scan.
  void ShowStage(const std::string& stage);

  void Clear();

 private:
  using Clock = std::chrono::steady_clock;

  void Draw(const std::string& line);

  bool enabled_;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_ = start_;
};

}  // namespace loopgrid
