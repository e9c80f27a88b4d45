#pragma once

#include <string>

namespace loopgrid {

/// Throws Error (kUsage) if the name of a picture, given with `option`, promises something else
/// than PNG.
void RequirePngName(const std::string& option, const std::string& path);

}  // namespace loopgrid
