#pragma once

#include <string_view>

namespace loopgrid {

/// Whether a text can be the name of a class in a stream of MRPT objects.
bool IsMrptClassName(std::string_view text);

/// Whether a file with this beginning is a stream of MRPT objects (not gzipped).
bool LooksLikeRawlog(std::string_view start);

}  // namespace loopgrid
