#pragma once

#include <string>
#include <string_view>

namespace loopgrid {

/// The bytes packed as a gzip file. Equal bytes give equal results: the header has neither a name
/// nor a date.
std::string Gzip(std::string_view bytes);

}  // namespace loopgrid
