#pragma once

#include <string>
#include <string_view>

namespace loopgrid {

/// The bytes as a gzip file has them; the same each time (no name, no date).
std::string Gzip(std::string_view bytes);

}  // namespace loopgrid
