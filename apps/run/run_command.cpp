#include "apps/run/run_command.h"

#include <filesystem>
#include <string>
#include <system_error>

#include "apps/cli/interrupt_watch.h"
#include "apps/cli/progress_bar.h"
#include "apps/output/output_directory.h"
#include "apps/output/same_file.h"
#include "apps/output/session_names.h"
#include "apps/output/standard_output.h"
#include "apps/run/finish_run.h"
#include "apps/run/report.h"
#include "apps/run/run_outputs.h"
#include "backend/base/error.h"
#include "backend/base/stopwatch.h"
#include "frontend/log/open_log.h"
#include "frontend/slam/slam.h"

namespace loopgrid {
namespace {

/// The log is read twice: to map it, then to correct it. A pipe can be read only once.
void RequireFile(const std::string& log) {
  std::error_code ignored;
  if (!std::filesystem::is_other(log, ignored)) return;
  throw Error(ErrorCode::kInput, log + ": is a device or a pipe; a log has to be a file");
}

/// The files must not replace a session of `loopgrid online` or the log itself.
void RequireFreePlaces(const RunOptions& options) {
  std::error_code ignored;
  for (const char* name : {kSessionName, kJournalName}) {
    if (!std::filesystem::exists(options.out + "/" + name, ignored)) continue;
    throw Error(ErrorCode::kOutput, options.out + ": holds a session of loopgrid online (" + name +
                                        "); choose another folder");
  }
  for (const std::string& name : RunOutputNames()) {
    RequireOtherThanInput("--out", options.out + "/" + name, options.log);
  }
}

/// Feeds the whole log to `slam`.
void MapLog(LogReader* log, Slam* slam, ProgressBar* bar, RunReport* report) {
  RecordingClock clock;
  Observation observation;
  const auto read_next = [&] {
    const Stopwatch reading;
    const bool has_next = log->Next(&observation);
    report->reading_seconds += reading.seconds();
    return has_next;
  };
  while (read_next()) {
    clock.Add(observation.timestamp);
    slam->AddScan(observation);
    bar->Update(log->progress(), slam->scan_count());
  }
  report->data_seconds = clock.seconds();
  report->log = log->statistics();
}

}  // namespace

void RunCommand(const RunOptions& options) {
  const Stopwatch stopwatch;
  options.Validate();
  RequireFile(options.log);
  LogReaderOptions log_options;
  log_options.strict = options.strict;
  const auto log = OpenLog(options.log, log_options);

  // Fail now and not after a long run. The watch is made before Prepare(), so that an interrupt
  // never leaves unfinished files.
  RequireFreePlaces(options);
  OutputDirectory outputs(options.out, RunOutputNames());
  const InterruptWatch watch([&outputs] { outputs.Discard(); });
  outputs.Prepare();

  RunReport report;
  report.options = options;
  ProgressBar bar(options.quiet);
  Slam slam(options.slam);
  MapLog(log.get(), &slam, &bar, &report);
  RequireScans(options.log, report.log);
  FinishRun(stopwatch, &slam, &outputs, &bar, &report);
  PrintToStandardOutput(FormatSummary(report));
}

}  // namespace loopgrid
