#pragma once

#include <string>

namespace loopgrid {

/// Prints to standard output and makes sure that it got there. Throws Error (kOutput) if not: the
/// disk is full, the pipe closed.
void PrintToStandardOutput(const std::string& text);

}  // namespace loopgrid
