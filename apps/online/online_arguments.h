#pragma once

#include "apps/cli/command.h"
#include "apps/online/online_options.h"

namespace loopgrid {

/// The command `loopgrid online`, which sets `options` and acts on them.
Command DescribeOnline(OnlineOptions* options);

}  // namespace loopgrid
