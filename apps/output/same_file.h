#pragma once

#include <string>

namespace loopgrid {

/// Whether two paths mean the same file: the same one by whatever name, or, if one is not there
/// (yet), the same place. Devices and pipes are no files in this sense: false. Throws nothing.
bool IsSameFile(const std::string& a, const std::string& b);

/// Throws Error (kUsage) if a command would write `output`, given with `option`, over its own
/// `input`.
void RequireOtherThanInput(const std::string& option, const std::string& output,
                           const std::string& input);

}  // namespace loopgrid
