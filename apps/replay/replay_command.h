#pragma once

#include "apps/replay/replay_options.h"

namespace loopgrid {

/// Plays a log to standard output or to a socket: every line byte for byte, at its time. Throws
/// Error.
void ReplayCommand(const ReplayOptions& options);

}  // namespace loopgrid
