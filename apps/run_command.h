#pragma once

#include "apps/run_options.h"

namespace loopgrid {

/// Maps a log: reads it to the end, writes the files, prints a summary. Throws Error.
void RunCommand(const RunOptions& options);

}  // namespace loopgrid
