#pragma once

#include <span>

#include "backend/base/line_reader.h"

namespace loopgrid {

/// Reads the next line that is neither blank nor a comment (`#`) as exactly so many finite numbers;
/// false at the end of the file. Throws Error (kInput) `file:line: ...` for any other line.
bool NextNumberLine(LineReader* lines, std::span<double> numbers);

}  // namespace loopgrid
