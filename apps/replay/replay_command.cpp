#include "apps/replay/replay_command.h"

#include <fmt/format.h>

#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "apps/cli/interrupt_watch.h"
#include "apps/replay/raw_line_reader.h"
#include "apps/replay/replay_output.h"
#include "apps/replay/replay_schedule.h"
#include "backend/base/error.h"
#include "frontend/log/carmen/carmen_line.h"
#include "frontend/log/rawlog/rawlog_format.h"

namespace loopgrid {
namespace {

using Clock = std::chrono::steady_clock;

RawLineReader OpenLines(const std::string& path) {
  InputFile file(path);
  const std::string_view start = file.Peek(4096);
  if (start.empty()) throw Error(ErrorCode::kInput, path + ": is empty");
  if (LooksLikeRawlog(start) || start.find('\0') != start.npos) {
    throw Error(ErrorCode::kInput, path + ": only CARMEN logs can be played, which are text");
  }
  return RawLineReader(std::move(file));
}

std::optional<double> TimeOfScan(std::string_view line) {
  if (!IsLaser(TagOf(line))) return std::nullopt;
  while (line.ends_with('\n') || line.ends_with('\r')) line.remove_suffix(1);
  CarmenLaserMessage message;
  if (!ParseLaserLine(line, &message).empty()) return std::nullopt;
  return message.timestamp;
}

/// A log that is played without end has to have a scan: without time stamps the loop would never
/// wait.
void RequireScan(const ReplayOptions& options) {
  RawLineReader lines = OpenLines(options.log);
  std::string_view piece;
  while (lines.Next(&piece)) {
    const bool is_played = lines.line_number() >= options.from_line;
    if (is_played && lines.whole() && TimeOfScan(piece)) return;
  }
  throw Error(ErrorCode::kInput,
              fmt::format("{}: has no scan from line {} on, so it cannot be played without end",
                          options.log, options.from_line));
}

/// Plays logs to an output. Lines that are due at the same time are written together.
class Player {
 public:
  Player(const ReplayOptions& options, const ReplayOutput* output)
      : options_(options), output_(output), schedule_(options.speed) {}

  /// Plays the log once. If the log has no line end at its end, writes one before the next round.
  void Play(RawLineReader* lines);

  /// Writes the lines that wait to be written together.
  void Flush();

  /// Stops writing. Waits up to a second until the line being written is complete.
  void Stop() { static_cast<void>(writing_.try_lock_for(std::chrono::seconds(1))); }

 private:
  void WaitUntil(double due);

  const ReplayOptions& options_;
  const ReplayOutput* output_;
  ReplaySchedule schedule_;
  Clock::time_point start_ = Clock::now();
  std::string held_back_;
  bool lacks_line_end_ = false;  // what was played so far
  std::timed_mutex writing_;
};

void Player::Play(RawLineReader* lines) {
  if (std::exchange(lacks_line_end_, false)) held_back_ += '\n';
  constexpr std::size_t kEnough = std::size_t{1} << 16;
  std::string_view piece;
  const auto next = [&] {
    try {
      return lines->Next(&piece);
    } catch (const Error&) {
      Flush();  // the log is damaged here; the lines before are good
      throw;
    }
  };
  while (next()) {
    if (lines->line_number() < options_.from_line) continue;
    if (options_.speed > 0.0 && lines->whole()) {
      if (const auto time = TimeOfScan(piece)) WaitUntil(schedule_.Due(*time));
    }
    held_back_ += piece;
    if (held_back_.size() >= kEnough) Flush();
  }
  if (lines->line_number() < options_.from_line) {
    throw Error(ErrorCode::kInput, fmt::format("{}: has no line {}, only {}", options_.log,
                                               options_.from_line, lines->line_number()));
  }
  lacks_line_end_ = !lines->ends_line();
}

void Player::Flush() {
  const std::lock_guard lock(writing_);
  output_->Write(held_back_);
  held_back_.clear();
}

void Player::WaitUntil(double due) {
  const auto moment =
      start_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(due));
  if (Clock::now() >= moment) return;
  Flush();
  std::this_thread::sleep_until(moment);
}

}  // namespace

void ReplayCommand(const ReplayOptions& options) {
  options.Validate();
  if (options.loop == 0) RequireScan(options);
  RawLineReader lines = OpenLines(options.log);
  const ReplayOutput output =
      options.to.empty() ? ReplayOutput() : ReplayOutput(ParseHostPort(options.to));
  Player player(options, &output);
  const InterruptWatch watch([&player] { player.Stop(); });
  for (std::int64_t round = 1; options.loop == 0 || round <= options.loop; ++round) {
    if (round > 1) lines = OpenLines(options.log);
    player.Play(&lines);
  }
  player.Flush();
  output.Finish();
}

}  // namespace loopgrid
