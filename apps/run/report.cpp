#include "apps/run/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

namespace loopgrid {
namespace {

using Json = nlohmann::ordered_json;

std::int64_t CountTried(const RunReport& report) {
  std::int64_t tried = 0;
  for (const auto& [outcome, count] : report.closures) tried += count;
  return tried;
}

std::int64_t CountAccepted(const RunReport& report) {
  const auto found = report.closures.find(ToString(ClosureOutcome::kAccepted));
  return found == report.closures.end() ? 0 : found->second;
}

double RealTimeFactor(const RunReport& report) {
  return report.total_seconds > 0.0 ? report.data_seconds / report.total_seconds : 0.0;
}

Json OptionsJson(const RunOptions& options) {
  return {{"resolution", options.resolution},
          {"node_distance", options.slam.node_distance},
          {"node_angle", options.slam.node_angle},
          {"strict", options.strict}};
}

Json LogJson(const RunReport& report) {
  const LogStatistics& log = report.log;
  return {{"file", report.options.log},
          {"lines", log.lines},
          {"scans", log.scans},
          {"odometry", log.odometry},
          {"ignored", log.ignored},
          {"malformed", log.malformed},
          {"first_problems", log.first_problems},
          {"seconds", report.data_seconds}};
}

Json ClosuresJson(const RunReport& report) {
  Json json = {{"tried", CountTried(report)}, {"accepted", CountAccepted(report)}};
  json["outcomes"] = report.closures;
  return json;
}

Json TimingsJson(const RunReport& report) {
  const SlamTimes& times = report.slam.times;
  return {{"total_s", report.total_seconds},
          {"reading_s", report.reading_seconds},
          {"tracking_s", times.tracking},
          {"closing_s", times.closing},
          {"optimizing_s", times.optimizing},
          {"finishing_s", times.finishing},
          {"drawing_s", report.drawing_seconds},
          {"writing_s", report.writing_seconds},
          {"real_time_factor", RealTimeFactor(report)},
          {"peak_memory_mb", report.peak_memory_mb}};
}

}  // namespace

void RecordingClock::Add(double timestamp) {
  constexpr double kLongestStep = 3600.0;
  const double step = timestamp - last_;
  if (started_ && std::abs(step) <= kLongestStep) sum_ += step;
  started_ = true;
  last_ = timestamp;
}

double RecordingClock::seconds() const { return std::max(sum_, 0.0); }

std::string FormatReportJson(const RunReport& report) {
  Json json;
  json["program"] = "loopgrid";
  json["version"] = LOOPGRID_VERSION;
  json["options"] = OptionsJson(report.options);
  json["log"] = LogJson(report);
  json["scans"] = report.slam.scans;
  json["failed_matches"] = report.slam.failed_matches;
  json["unusable_scans"] = report.slam.unusable_scans;
  json["nodes"] = report.nodes;
  json["constraints"] = report.constraints;
  json["closures"] = ClosuresJson(report);
  json["error"] = {{"before", report.slam.error_before}, {"after", report.slam.error_after}};
  json["map"] = {{"width", report.map_width},
                 {"height", report.map_height},
                 {"resolution", report.options.resolution}};
  json["timings"] = TimingsJson(report);
  // File names need not be UTF-8; JSON does.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::string FormatSummary(const RunReport& report) {
  const double cell = report.options.resolution;
  std::string text;
  const auto add_line = [&text]<typename... Args>(fmt::format_string<Args...> format,
                                                  Args&&... args) {
    fmt::format_to(std::back_inserter(text), format, std::forward<Args>(args)...);
    text += '\n';
  };
  add_line("scans      {} ({} carried by odometry alone)", report.slam.scans,
           report.slam.failed_matches);
  add_line("graph      {} nodes, {} constraints", report.nodes, report.constraints);
  add_line("closures   {} made of {} tried", CountAccepted(report), CountTried(report));
  add_line("error      {:.6g} before, {:.6g} after", report.slam.error_before,
           report.slam.error_after);
  add_line("map        {} x {} cells of {} m ({:.1f} m x {:.1f} m)", report.map_width,
           report.map_height, cell, report.map_width * cell, report.map_height * cell);
  add_line("time       {:.2f} s for {:.0f} s of data ({:.0f} x real time), {:.0f} MB at most",
           report.total_seconds, report.data_seconds, RealTimeFactor(report),
           report.peak_memory_mb);
  if (report.log.malformed > 0) {
    add_line("malformed  {} lines skipped, the first:", report.log.malformed);
    for (const std::string& problem : report.log.first_problems) add_line("  {}", problem);
  }
  add_line("files      in {}", report.options.out);
  return text;
}

}  // namespace loopgrid
