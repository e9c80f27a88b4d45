#pragma once

#include "apps/cli/command.h"
#include "apps/online/online_options.h"

namespace loopgrid {

/// The command `loopgrid online`. It sets `options` and then runs with them.
Command DescribeOnline(OnlineOptions* options);

}  // namespace loopgrid
