#pragma once

#include <string_view>

namespace loopgrid {

/// The page: one HTML document with its styles and scripts in it, made of page/ by the build.
std::string_view ViewPage();

/// Its Content-Security-Policy: allows exactly these styles and scripts, and nothing from
/// elsewhere.
std::string_view ViewPagePolicy();

}  // namespace loopgrid
