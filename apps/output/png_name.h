#pragma once

#include <string>

namespace loopgrid {

/// Throws Error (kUsage) if a picture's name promises something else than PNG.
void RequirePngName(const std::string& path);

}  // namespace loopgrid
