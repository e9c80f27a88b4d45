#pragma once

#include <cstddef>
#include <vector>

namespace loopgrid {

/// Statistics of errors that are 0 or positive. All are zero if there are no errors.
struct ErrorSummary {
  std::size_t count = 0;
  double mean = 0.0;
  double standard_deviation = 0.0;  ///< of the population: divided by the count
  double squared_mean = 0.0;        ///< mean of the squares
  double rms = 0.0;                 ///< square root of squared_mean
  double median = 0.0;
  double maximum = 0.0;
};

ErrorSummary Summarize(std::vector<double> errors);

}  // namespace loopgrid
