#pragma once

#include <string>
#include <vector>

#include "frontend/closing/closure.h"

namespace loopgrid {

/// All closures tried as CSV text: a header, then one line for each, in order. Metres, radians,
/// seconds; x, y, theta and the covariance are those of T_from_to.
std::string FormatClosuresCsv(const std::vector<Closure>& closures);

}  // namespace loopgrid
