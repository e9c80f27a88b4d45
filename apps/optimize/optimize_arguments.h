#pragma once

#include "apps/cli/command.h"
#include "apps/optimize/optimize_options.h"

namespace loopgrid {

/// The command `loopgrid optimize`. It sets `options` and then runs with them.
Command DescribeOptimize(OptimizeOptions* options);

}  // namespace loopgrid
