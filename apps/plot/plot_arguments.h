#pragma once

#include "apps/cli/command.h"
#include "apps/plot/plot_command.h"

namespace loopgrid {

/// The command `loopgrid plot`, which sets `options` and acts on them.
Command DescribePlot(PlotOptions* options);

}  // namespace loopgrid
