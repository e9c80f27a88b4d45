#pragma once

#include <string>

namespace loopgrid {

/// Whether two paths lead to the same file, by any name. If one of them does not exist yet, whether
/// they are the same place. False for devices and pipes. Throws nothing.
bool IsSameFile(const std::string& a, const std::string& b);

/// Throws Error (kUsage) if a command would write `output`, given with `option`, over its own
/// `input`.
void RequireOtherThanInput(const std::string& option, const std::string& output,
                           const std::string& input);

}  // namespace loopgrid
