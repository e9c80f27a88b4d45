#include "apps/cli/progress_bar.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace loopgrid {
namespace {

constexpr int kLongestBar = 30;
constexpr int kShortestBar = 5;
constexpr std::chrono::milliseconds kBetweenRedraws(100);
constexpr double kTooEarlyToTell = 0.5;  // seconds

std::string FormatTimeLeft(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::ceil(seconds));
  if (whole >= 3600) return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
  if (whole >= 60) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} s", whole);
}

int TerminalWidth() {
  winsize size = {};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col;
}

}  // namespace

std::string FormatProgress(double fraction, std::int64_t scans, double seconds, int width) {
  std::string text = fmt::format("{} scans", scans);
  const bool can_tell = seconds >= kTooEarlyToTell;
  if (can_tell) text += fmt::format(", {:.0f}/s", static_cast<double>(scans) / seconds);
  if (fraction > 0.0) {
    fraction = std::min(fraction, 1.0);
    if (can_tell) {
      text += fmt::format(", {} left", FormatTimeLeft(seconds * (1.0 - fraction) / fraction));
    }
    text = fmt::format("{:3.0f} %  {}", std::floor(100.0 * fraction), text);
    const int length = std::min(width - static_cast<int>(text.size()) - 3, kLongestBar);
    if (length >= kShortestBar) {
      const int full = static_cast<int>(fraction * length);
      text = fmt::format("[{:<{}}] {}", std::string(static_cast<size_t>(full), '#'), length, text);
    }
  }
  return text.substr(0, static_cast<size_t>(std::max(width, 0)));
}

ProgressBar::ProgressBar(bool quiet) : enabled_(!quiet && isatty(STDERR_FILENO) == 1) {}

void ProgressBar::Update(double fraction, std::int64_t scans) {
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  next_ = now + kBetweenRedraws;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  // The last column is not used, because some terminals would begin a new line.
  Draw(FormatProgress(fraction, scans, seconds, TerminalWidth() - 1));
}

void ProgressBar::ShowStage(const std::string& stage) {
  if (enabled_) Draw(stage);
}

void ProgressBar::Clear() {
  if (drawn_) Draw("");
  drawn_ = false;
}

void ProgressBar::Draw(const std::string& line) {
  constexpr const char* kEraseToEnd = "\033[K";
  std::fprintf(stderr, "\r%s%s", line.c_str(), kEraseToEnd);
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace loopgrid
