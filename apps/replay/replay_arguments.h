#pragma once

#include "apps/cli/command.h"
#include "apps/replay/replay_options.h"

namespace loopgrid {

/// The command `loopgrid replay`. It sets `options` and then runs with them.
Command DescribeReplay(ReplayOptions* options);

}  // namespace loopgrid
