#pragma once

#include "apps/cli/command.h"
#include "apps/settings/run_options.h"

namespace loopgrid {

/// The command `loopgrid run`. It sets `options` and then runs with them.
Command DescribeRun(RunOptions* options);

}  // namespace loopgrid
