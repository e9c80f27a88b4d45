#pragma once

#include <span>

#include "apps/cli/command.h"

namespace loopgrid {

/// Throws Error (kUsage) if the words of a command line (without the program's own name) contain a
/// command or an option that there is not; the message suggests the nearest one that there is, and
/// names the help to look into.
void RefuseUnknownNames(const Program& program, std::span<const char* const> words);

}  // namespace loopgrid
