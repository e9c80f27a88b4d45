#pragma once

#include <span>

#include "apps/cli/command.h"

namespace loopgrid {

/// Throws Error (kUsage) if the words of a command line (without the program's own name) contain a
/// command or an option that does not exist. The message suggests the most similar one that exists,
/// and names the help to read.
void RefuseUnknownNames(const Program& program, std::span<const char* const> words);

}  // namespace loopgrid
