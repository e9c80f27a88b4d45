#include "apps/online/event_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void Fail(const std::string& path, const char* doing) {
  const int reason = errno;
  throw Error(ErrorCode::kOutput,
              path + ": " + doing + ": " + std::generic_category().message(reason));
}

Descriptor OpenOutput(const std::string& path) {
  if (path == "-") return Descriptor(fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
  return Descriptor(open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
}

/// JSON has no other numbers.
struct Number {
  double value;
};

std::string Line(const Json& event) {
  // File names need not be UTF-8; JSON does.
  return event.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace
}  // namespace loopgrid

template <>
struct fmt::formatter<loopgrid::Number> : fmt::formatter<double> {
  template <typename Context>
  auto format(loopgrid::Number number, Context& context) const {
    if (!std::isfinite(number.value)) return fmt::format_to(context.out(), "null");
    return fmt::formatter<double>::format(number.value, context);
  }
};

namespace loopgrid {
namespace {

void AddPose(const SE2& pose, std::string* text) {
  fmt::format_to(std::back_inserter(*text), R"("x":{:.6f},"y":{:.6f},"theta":{:.6f})",
                 Number{pose.x()}, Number{pose.y()}, Number{pose.theta()});
}

void AddScan(const OnlineUpdate& update, std::string* text) {
  const TrackedScan& scan = update.tracked;
  fmt::format_to(std::back_inserter(*text),
                 R"({{"event":"pose","scan":{},"line":{},"time":{:.6f},)", scan.scan, update.line,
                 Number{update.timestamp});
  AddPose(scan.T_map_robot, text);
  const Eigen::Matrix3d& cov = scan.covariance;
  fmt::format_to(std::back_inserter(*text),
                 R"(,"covariance":[{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g}],"matched":{},)"
                 R"("localized":{},"latency_ms":{:.3f}}})"
                 "\n",
                 Number{cov(0, 0)}, Number{cov(0, 1)}, Number{cov(0, 2)}, Number{cov(1, 1)},
                 Number{cov(1, 2)}, Number{cov(2, 2)}, scan.matched, scan.localized,
                 Number{1e3 * update.latency_seconds});
}

void AddNode(const OnlineUpdate& update, std::string* text) {
  fmt::format_to(std::back_inserter(*text), R"({{"event":"node","node":{},"scan":{},)",
                 update.tracked.node, update.tracked.scan);
  AddPose(update.tracked.T_map_robot, text);
  *text += "}\n";
}

void AddClosure(const Closure& closure, std::string* text) {
  fmt::format_to(std::back_inserter(*text),
                 R"({{"event":"closure","from":{},"to":{},"outcome":"{}","score":{:.4f},)"
                 R"("chi2":{:.4g},"reason":"{}"}})"
                 "\n",
                 closure.from, closure.to, ToString(closure.outcome), Number{closure.score},
                 Number{closure.chi2}, Explain(closure.outcome));
}

}  // namespace

EventWriter::EventWriter(const std::string& path)
    : path_(path == "-" ? "standard output" : path), output_(OpenOutput(path)) {
  if (!output_) Fail(path_, "cannot open");
}

void EventWriter::Start(const OnlineOptions& options, const std::string& source,
                        const std::string& page) {
  if (!enabled()) return;
  buffer_ += Line({{"event", "start"},
                   {"version", LOOPGRID_VERSION},
                   {"source", source},
                   {"page", page},
                   {"folder", options.run.out},
                   {"options",
                    {{"resolution", options.run.resolution},
                     {"node_distance", options.run.slam.node_distance},
                     {"node_angle", options.run.slam.node_angle},
                     {"strict", options.run.strict}}}});
}

void EventWriter::Resumed(std::int64_t lines, std::int64_t scans) {
  if (enabled()) buffer_ += Line({{"event", "resumed"}, {"lines", lines}, {"scans", scans}});
}

void EventWriter::Known(std::int64_t lines) {
  if (enabled()) buffer_ += Line({{"event", "known"}, {"lines", lines}});
}

void EventWriter::Scan(const OnlineUpdate& update) {
  if (!enabled()) return;
  AddScan(update, &buffer_);
  if (update.tracked.node >= 0) AddNode(update, &buffer_);
  for (const Closure& closure : update.closures) AddClosure(closure, &buffer_);
  if (update.tracked.optimized) {
    fmt::format_to(std::back_inserter(buffer_),
                   R"({{"event":"optimization","scan":{}}})"
                   "\n",
                   update.tracked.scan);
  }
}

void EventWriter::Warning(const std::string& text) {
  if (enabled()) buffer_ += Line({{"event", "warning"}, {"text", text}});
}

void EventWriter::Saved(std::int64_t scans) {
  if (enabled()) buffer_ += Line({{"event", "saved"}, {"scans", scans}});
}

void EventWriter::End(std::int64_t lines, std::int64_t scans, bool stopped) {
  if (!enabled()) return;
  buffer_ += Line({{"event", "end"}, {"lines", lines}, {"scans", scans}, {"stopped", stopped}});
}

void EventWriter::Flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t count = write(output_.get(), rest.data(), rest.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) Fail(path_, "cannot write");
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
  buffer_.clear();
}

}  // namespace loopgrid
