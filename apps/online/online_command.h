#pragma once

#include "apps/online/online_options.h"

namespace loopgrid {

/// Maps lines as they arrive, until the stream ends or a signal arrives. Then writes the files of a
/// run and prints a summary. Throws Error.
void OnlineCommand(OnlineOptions options);

}  // namespace loopgrid
