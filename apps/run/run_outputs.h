#pragma once

#include <string>
#include <vector>

#include "apps/output/output_directory.h"
#include "apps/run/report.h"
#include "apps/settings/run_options.h"
#include "frontend/evaluation/tum_file.h"
#include "frontend/slam/slam.h"

namespace loopgrid {

/// The names of all files that a run writes.
std::vector<std::string> RunOutputNames();

/// The poses of a run's scans with their times.
Trajectory StampPoses(const Slam& slam, const std::vector<SE2>& poses);

/// Writes all files except report.json, and completes `report`. A picture or a map that is too
/// large is drawn coarser or left out, with a note in the report. Throws Error.
void WriteRunOutputs(const RunOptions& options, const Slam& slam, OutputDirectory* outputs,
                     RunReport* report);

}  // namespace loopgrid
