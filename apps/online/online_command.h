#pragma once

#include "apps/online/online_options.h"

namespace loopgrid {

/// Maps lines as they come, until they end or a signal does; writes the files of a run, prints a
/// summary. Throws Error.
void OnlineCommand(OnlineOptions options);

}  // namespace loopgrid
