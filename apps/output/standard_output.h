#pragma once

#include <string>

namespace loopgrid {

/// Prints to standard output. Throws Error (kOutput) if that fails, for example because the disk is
/// full or the pipe is closed.
void PrintToStandardOutput(const std::string& text);

}  // namespace loopgrid
