#include "apps/online/online_status.h"

#include <nlohmann/json.hpp>

#include "apps/output/peak_memory.h"

namespace loopgrid {
namespace {

using Json = nlohmann::ordered_json;

Json LatencyJson(const LatencyHistogram& latency) {
  return {{"median", 1e3 * latency.Quantile(0.5)},
          {"p99", 1e3 * latency.Quantile(0.99)},
          {"p99_9", 1e3 * latency.Quantile(0.999)},
          {"max", 1e3 * latency.max()}};
}

Json SourceJson(const OnlineStatus& status) {
  const SourceCounters& counters = status.counters;
  return {{"name", status.source},
          {"connections", counters.connections},
          {"refused", counters.refused},
          {"failures", counters.failures},
          {"rotations", counters.rotations},
          {"truncations", counters.truncations},
          {"last_problem", counters.last_problem}};
}

}  // namespace

std::string FormatStatus(const OnlineStatus& status) {
  const Json json = {
      {"program", "loopgrid"},
      {"version", LOOPGRID_VERSION},
      {"scans", status.scans},
      {"nodes", status.nodes},
      {"constraints", status.constraints},
      {"closures", {{"tried", status.closures_tried}, {"accepted", status.closures_accepted}}},
      {"unmatched", status.unmatched},
      {"localized", status.localized},
      {"latency_ms", LatencyJson(status.latency)},
      {"lines", status.log.lines},
      {"malformed", status.log.malformed},
      {"queue",
       {{"waiting", status.queue.waiting_lines},
        {"lines", status.queue.lines},
        {"bytes", status.queue.bytes},
        {"waits", status.queue.waits}}},
      {"source", SourceJson(status)},
      {"memory_mb", MemoryMb()},
      {"peak_memory_mb", PeakMemoryMb()}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace loopgrid
