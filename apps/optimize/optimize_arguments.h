#pragma once

#include "apps/cli/command.h"
#include "apps/optimize/optimize_options.h"

namespace loopgrid {

/// The command `loopgrid optimize`, which sets `options` and acts on them.
Command DescribeOptimize(OptimizeOptions* options);

}  // namespace loopgrid
