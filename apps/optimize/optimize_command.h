#pragma once

#include "apps/optimize/optimize_options.h"

namespace loopgrid {

/// Optimises a graph: reads it, writes what is asked for, prints a summary. Throws Error, also if
/// the optimisation has no result: F is not finite, no step can be made, or covariances do not
/// exist.
void OptimizeCommand(const OptimizeOptions& options);

}  // namespace loopgrid
