#pragma once

#include "apps/cli/command.h"
#include "apps/plot/plot_command.h"

namespace loopgrid {

/// The command `loopgrid plot`. It sets `options` and then runs with them.
Command DescribePlot(PlotOptions* options);

}  // namespace loopgrid
