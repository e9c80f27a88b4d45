#include "apps/run/finish_run.h"

#include <fmt/format.h>

#include <cstdio>

#include "apps/output/peak_memory.h"
#include "apps/run/run_outputs.h"
#include "backend/base/error.h"

namespace loopgrid {
namespace {

void DescribeRun(const Slam& slam, RunReport* report) {
  report->slam = slam.statistics();
  report->nodes = static_cast<int>(slam.graph().poses.size());
  report->constraints = static_cast<int>(slam.graph().constraints.size());
  for (const Closure& closure : slam.closures()) {
    ++report->closures[ToString(closure.outcome)];
  }
}

}  // namespace

void RequireScans(const std::string& name, const LogStatistics& log) {
  if (log.scans > 0) return;
  std::string message = fmt::format("{}: no laser scan in it", name);
  if (!log.first_problems.empty()) {
    message += fmt::format(" ({} malformed lines, the first: {})", log.malformed,
                           log.first_problems.front());
  }
  throw Error(ErrorCode::kInput, message);
}

void FinishRun(const Stopwatch& stopwatch, Slam* slam, OutputDirectory* outputs, ProgressBar* bar,
               RunReport* report) {
  bar->ShowStage("optimising the graph");
  slam->Finish();
  DescribeRun(*slam, report);

  bar->ShowStage("drawing and writing");
  WriteRunOutputs(report->options, *slam, outputs, report);
  report->total_seconds = stopwatch.seconds();
  report->peak_memory_mb = PeakMemoryMb();
  outputs->Write("report.json", FormatReportJson(*report));
  outputs->Commit();
  bar->Clear();
  for (const std::string& note : report->notes) {
    std::fprintf(stderr, "loopgrid: note: %s\n", note.c_str());
  }
}

}  // namespace loopgrid
