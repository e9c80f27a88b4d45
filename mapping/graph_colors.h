#pragma once

#include "mapping/color.h"

namespace loopgrid {

// The colours of graph.png and of the pictures that `optimize --picture` draws.
inline constexpr Color kSequentialColor{30, 100, 190};  ///< constraints between consecutive nodes
inline constexpr Color kClosureColor{225, 75, 35};      ///< constraints that close a loop
inline constexpr Color kLandmarkColor{20, 140, 60};

}  // namespace loopgrid
