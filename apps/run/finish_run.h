#pragma once

#include <string>

#include "apps/cli/progress_bar.h"
#include "apps/output/output_directory.h"
#include "apps/run/report.h"
#include "backend/base/stopwatch.h"
#include "frontend/slam/slam.h"

namespace loopgrid {

/// Throws Error (kInput) if there was no scan in what came from `name`.
void RequireScans(const std::string& name, const LogStatistics& log);

/// The end of every run, whether its scans stood in a file or came while the robot drove: settles
/// the graph, completes `report` and leaves all files. `report` holds the options and what is known
/// of the log; `stopwatch` runs since the beginning. The report's notes go to standard error.
/// Throws Error.
void FinishRun(const Stopwatch& stopwatch, Slam* slam, OutputDirectory* outputs, ProgressBar* bar,
               RunReport* report);

}  // namespace loopgrid
