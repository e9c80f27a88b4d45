#pragma once

#include <string>

namespace loopgrid {

/// Loads a part of the program that most commands do not need: a shared library beside the program
/// or in its library folder. It stays loaded. Error messages say what it is for: `purpose`. Returns
/// the address of its function `function`. Throws std::runtime_error if the module or a library
/// that it needs is missing, or if it belongs to another version of the program.
void* LoadFromModule(const std::string& file, const std::string& function,
                     const std::string& purpose);

}  // namespace loopgrid
