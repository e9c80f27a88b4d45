#include "apps/run/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "apps/output/json_writer.h"
#include "apps/settings/mapping_options.h"

namespace loopgrid {
namespace {

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

void AddLog(const RunReport& report, JsonWriter* json) {
  const LogStatistics& log = report.log;
  json->Key("log").BeginObject();
  json->Field("file", report.options.log)
      .Field("lines", log.lines)
      .Field("scans", log.scans)
      .Field("odometry", log.odometry)
      .Field("ignored", log.ignored)
      .Field("malformed", log.malformed)
      .Field("first_problems", log.first_problems)
      .Field("seconds", report.data_seconds);
  json->EndObject();
}

void AddClosures(const RunReport& report, JsonWriter* json) {
  json->Key("closures").BeginObject();
  json->Field("tried", CountTried(report)).Field("accepted", CountAccepted(report));
  json->Key("outcomes").BeginObject();
  for (const auto& [outcome, count] : report.closures) json->Field(outcome, count);
  json->EndObject().EndObject();
}

void AddMap(const RunReport& report, JsonWriter* json) {
  json->Key("map").BeginObject();
  json->Field("width", report.map_width)
      .Field("height", report.map_height)
      .Field("resolution", report.map_resolution);
  json->EndObject();
}

void AddTimings(const RunReport& report, JsonWriter* json) {
  const SlamTimes& times = report.slam.times;
  json->Key("timings").BeginObject();
  json->Field("total_s", report.total_seconds)
      .Field("reading_s", report.reading_seconds)
      .Field("tracking_s", times.tracking)
      .Field("closing_s", times.closing)
      .Field("optimizing_s", times.optimizing)
      .Field("finishing_s", times.finishing)
      .Field("drawing_s", report.drawing_seconds)
      .Field("writing_s", report.writing_seconds)
      .Field("real_time_factor", RealTimeFactor(report))
      .Field("peak_memory_mb", report.peak_memory_mb);
  json->EndObject();
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
  JsonWriter json(JsonWriter::Layout::kIndented);
  json.BeginObject().Field("program", "loopgrid").Field("version", LOOPGRID_VERSION);
  json.Key("options").BeginObject();
  AddMappingFields(report.options, &json);
  json.EndObject();
  AddLog(report, &json);
  json.Field("scans", report.slam.scans)
      .Field("failed_matches", report.slam.failed_matches)
      .Field("unusable_scans", report.slam.unusable_scans)
      .Field("nodes", report.nodes)
      .Field("constraints", report.constraints);
  AddClosures(report, &json);
  json.Key("error").BeginObject();
  json.Field("before", report.slam.error_before).Field("after", report.slam.error_after);
  json.EndObject();
  AddMap(report, &json);
  json.Field("notes", report.notes);
  AddTimings(report, &json);
  json.EndObject();
  return json.Take() + '\n';
}

std::string FormatSummary(const RunReport& report) {
  const double cell = report.map_resolution;
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
  if (report.map_width > 0) {
    add_line("map        {} x {} cells of {:.6g} m ({:.1f} m x {:.1f} m)", report.map_width,
             report.map_height, cell, report.map_width * cell, report.map_height * cell);
  }
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
