#include "apps/online/event_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>
#include <system_error>

#include "apps/output/closure_fields.h"
#include "apps/output/json_writer.h"
#include "apps/settings/mapping_options.h"
#include "backend/base/error.h"

namespace loopgrid {
namespace {

[[noreturn]] void FailAtEvents(const std::string& path, const char* doing) {
  const int reason = errno;
  throw Error(ErrorCode::kOutput,
              path + ": " + doing + ": " + std::generic_category().message(reason));
}

Descriptor OpenOutput(const std::string& path) {
  if (path == "-") return Descriptor(fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
  return Descriptor(open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
}

/// Begins an event: a JSON object on a line of its own.
JsonWriter Event(const char* name) {
  JsonWriter json(JsonWriter::Layout::kOneLine);
  json.BeginObject().Field("event", name);
  return json;
}

void Append(JsonWriter* event, std::string* text) {
  event->EndObject();
  *text += event->Take() + '\n';
}

void AddPose(const SE2& pose, JsonWriter* json) {
  json->Field("x", FixedNumber{pose.x(), 6})
      .Field("y", FixedNumber{pose.y(), 6})
      .Field("theta", FixedNumber{pose.theta(), 6});
}

void AppendScan(const OnlineUpdate& update, std::string* text) {
  const TrackedScan& scan = update.tracked;
  JsonWriter json = Event("pose");
  json.Field("scan", scan.scan)
      .Field("line", update.line)
      .Field("time", FixedNumber{update.timestamp, 6});
  AddPose(scan.T_map_robot, &json);
  const Eigen::Matrix3d& cov = scan.covariance;
  json.Key("covariance").BeginArray();
  for (const double entry : {cov(0, 0), cov(0, 1), cov(0, 2), cov(1, 1), cov(1, 2), cov(2, 2)}) {
    json.Value(RoundedNumber{entry, 4});
  }
  json.EndArray();
  json.Field("matched", scan.matched)
      .Field("localized", scan.localized)
      .Field("latency_ms", FixedNumber{1e3 * update.latency_seconds, 3});
  Append(&json, text);
}

void AppendNode(const OnlineUpdate& update, std::string* text) {
  JsonWriter json = Event("node");
  json.Field("node", update.tracked.node).Field("scan", update.tracked.scan);
  AddPose(update.tracked.T_map_robot, &json);
  Append(&json, text);
}

void AppendClosure(const Closure& closure, std::string* text) {
  JsonWriter json = Event("closure");
  AddClosureEventFields(closure, &json);
  Append(&json, text);
}

}  // namespace

EventWriter::EventWriter(const std::string& path)
    : path_(path == "-" ? "standard output" : path), output_(OpenOutput(path)) {
  if (!output_) FailAtEvents(path_, "cannot open");
}

void EventWriter::Start(const OnlineOptions& options, const std::string& source,
                        const std::string& page) {
  if (!enabled()) return;
  JsonWriter json = Event("start");
  json.Field("version", LOOPGRID_VERSION)
      .Field("source", source)
      .Field("page", page)
      .Field("folder", options.run.out);
  json.Key("options").BeginObject();
  AddMappingFields(options.run, &json);
  json.EndObject();
  Append(&json, &buffer_);
}

void EventWriter::Resumed(std::int64_t lines, std::int64_t scans) {
  if (!enabled()) return;
  JsonWriter json = Event("resumed");
  json.Field("lines", lines).Field("scans", scans);
  Append(&json, &buffer_);
}

void EventWriter::Known(std::int64_t lines) {
  if (!enabled()) return;
  JsonWriter json = Event("known");
  json.Field("lines", lines);
  Append(&json, &buffer_);
}

void EventWriter::Scan(const OnlineUpdate& update) {
  if (!enabled()) return;
  AppendScan(update, &buffer_);
  if (update.tracked.node >= 0) AppendNode(update, &buffer_);
  for (const Closure& closure : update.closures) AppendClosure(closure, &buffer_);
  if (!update.tracked.optimized) return;
  JsonWriter json = Event("optimization");
  json.Field("scan", update.tracked.scan);
  Append(&json, &buffer_);
}

void EventWriter::Warning(const std::string& text) {
  if (!enabled()) return;
  JsonWriter json = Event("warning");
  json.Field("text", text);
  Append(&json, &buffer_);
}

void EventWriter::Saved(std::int64_t scans) {
  if (!enabled()) return;
  JsonWriter json = Event("saved");
  json.Field("scans", scans);
  Append(&json, &buffer_);
}

void EventWriter::End(std::int64_t lines, std::int64_t scans, bool stopped) {
  if (!enabled()) return;
  JsonWriter json = Event("end");
  json.Field("lines", lines).Field("scans", scans).Field("stopped", stopped);
  Append(&json, &buffer_);
}

void EventWriter::Flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t count = write(output_.get(), rest.data(), rest.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) FailAtEvents(path_, "cannot write");
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
  buffer_.clear();
}

}  // namespace loopgrid
