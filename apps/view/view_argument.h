#pragma once

#include "apps/live/live_viewer.h"

namespace loopgrid {

/// The option `--view [HOST:]PORT`, which starts a ViewServer.
LiveViewerOption DescribeView();

}  // namespace loopgrid
