#pragma once

#include <string>

#include "apps/cli/progress_bar.h"
#include "apps/output/output_directory.h"
#include "apps/run/report.h"
#include "backend/base/stopwatch.h"
#include "frontend/slam/slam.h"

namespace loopgrid {

/// Throws Error (kInput) if the log `name` has no scan.
void RequireScans(const std::string& name, const LogStatistics& log);

/// Ends a run of `loopgrid run` or `loopgrid online`: optimises the graph, completes `report` and
/// writes all files. Before the call `report` has the options and the counts of the log;
/// `stopwatch` runs since the beginning. The report's notes go to standard error. Throws Error.
void FinishRun(const Stopwatch& stopwatch, Slam* slam, OutputDirectory* outputs, ProgressBar* bar,
               RunReport* report);

}  // namespace loopgrid
