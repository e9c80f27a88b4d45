#include "apps/online/online_status.h"

#include "apps/output/json_writer.h"
#include "apps/output/peak_memory.h"

namespace loopgrid {
namespace {

void AddLatency(const LatencyHistogram& latency, JsonWriter* json) {
  json->Key("latency_ms").BeginObject();
  json->Field("median", 1e3 * latency.Quantile(0.5))
      .Field("p99", 1e3 * latency.Quantile(0.99))
      .Field("p99_9", 1e3 * latency.Quantile(0.999))
      .Field("max", 1e3 * latency.max());
  json->EndObject();
}

void AddClosureCounts(const OnlineStatus& status, JsonWriter* json) {
  json->Key("closures").BeginObject();
  json->Field("tried", status.closures_tried).Field("accepted", status.closures_accepted);
  json->EndObject();
}

void AddQueue(const LineQueue::Counters& queue, JsonWriter* json) {
  json->Key("queue").BeginObject();
  json->Field("waiting", queue.waiting_lines)
      .Field("lines", queue.lines)
      .Field("bytes", queue.bytes)
      .Field("waits", queue.waits);
  json->EndObject();
}

void AddSource(const OnlineStatus& status, JsonWriter* json) {
  const SourceCounters& counters = status.counters;
  json->Key("source").BeginObject();
  json->Field("name", status.source)
      .Field("connections", counters.connections)
      .Field("refused", counters.refused)
      .Field("failures", counters.failures)
      .Field("rotations", counters.rotations)
      .Field("truncations", counters.truncations)
      .Field("last_problem", counters.last_problem);
  json->EndObject();
}

}  // namespace

std::string FormatStatus(const OnlineStatus& status) {
  JsonWriter json(JsonWriter::Layout::kIndented);
  json.BeginObject().Field("program", "loopgrid").Field("version", LOOPGRID_VERSION);
  json.Field("scans", status.scans)
      .Field("nodes", status.nodes)
      .Field("constraints", status.constraints);
  AddClosureCounts(status, &json);
  json.Field("unmatched", status.unmatched).Field("localized", status.localized);
  AddLatency(status.latency, &json);
  json.Field("lines", status.log.lines).Field("malformed", status.log.malformed);
  AddQueue(status.queue, &json);
  AddSource(status, &json);
  json.Field("memory_mb", MemoryMb()).Field("peak_memory_mb", PeakMemoryMb());
  json.EndObject();
  return json.Take() + '\n';
}

}  // namespace loopgrid
