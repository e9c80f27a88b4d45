#pragma once

#include "apps/cli/command.h"
#include "apps/replay/replay_options.h"

namespace loopgrid {

/// The command `loopgrid replay`, which sets `options` and acts on them.
Command DescribeReplay(ReplayOptions* options);

}  // namespace loopgrid
