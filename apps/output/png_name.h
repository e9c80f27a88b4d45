#pragma once

#include <string>

namespace loopgrid {

/// Throws Error (kUsage) if the name of a picture, given with `option`, has the ending of another
/// format than PNG.
void RequirePngName(const std::string& option, const std::string& path);

}  // namespace loopgrid
