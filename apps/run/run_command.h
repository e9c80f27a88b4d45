#pragma once

#include "apps/settings/run_options.h"

namespace loopgrid {

/// Maps a log: reads it to the end, writes the files, prints a summary. Throws Error.
void RunCommand(const RunOptions& options);

}  // namespace loopgrid
