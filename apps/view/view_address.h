#pragma once

#include <string_view>

#include "apps/view/view_options.h"

namespace loopgrid {

/// Options with the address `[HOST:]PORT` and the other defaults. HOST may be in brackets (IPv6).
/// Throws Error (kUsage) for other texts, and for a port that is not one.
ViewServerOptions ParseViewAddress(std::string_view address);

/// Throws Error (kUsage) if `port` is not 0 (any that is free) to 65535.
void RequireViewPort(int port);

}  // namespace loopgrid
