#pragma once

#include "apps/cli/command.h"
#include "apps/settings/run_options.h"

namespace loopgrid {

/// The command `loopgrid run`, which sets `options` and acts on them.
Command DescribeRun(RunOptions* options);

}  // namespace loopgrid
