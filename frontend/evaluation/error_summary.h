#pragma once

#include <cstddef>
#include <vector>

namespace loopgrid {

/// What errors, none of them negative, amount to. All zero where there are none.
struct ErrorSummary {
  std::size_t count = 0;
  double mean = 0.0;
  double standard_deviation = 0.0;  ///< of the population: divided by the count
  double squared_mean = 0.0;        ///< mean of the squares
  double rms = 0.0;                 ///< root of that
  double median = 0.0;
  double maximum = 0.0;
};

ErrorSummary Summarize(std::vector<double> errors);

}  // namespace loopgrid
