#pragma once

#include "apps/cli/command.h"
#include "apps/live/live_viewer.h"
#include "apps/online/online_options.h"

namespace loopgrid {

/// The command `loopgrid online` with `viewer` among its options. It sets `options` and then runs
/// with them.
Command DescribeOnline(OnlineOptions* options, LiveViewerOption viewer);

}  // namespace loopgrid
