#include "frontend/evaluation/error_summary.h"

#include <algorithm>
#include <cmath>

namespace loopgrid {

ErrorSummary Summarize(std::vector<double> errors) {
  ErrorSummary summary;
  summary.count = errors.size();
  if (errors.empty()) return summary;
  std::sort(errors.begin(), errors.end());
  const auto count = static_cast<double>(errors.size());
  for (const double error : errors) summary.mean += error / count;
  double variance = 0.0;
  for (const double error : errors) {
    variance += (error - summary.mean) * (error - summary.mean) / count;
    summary.squared_mean += error * error / count;
  }
  summary.standard_deviation = std::sqrt(variance);
  summary.rms = std::sqrt(summary.squared_mean);
  const std::size_t middle = errors.size() / 2;
  summary.median =
      errors.size() % 2 == 1 ? errors[middle] : 0.5 * (errors[middle - 1] + errors[middle]);
  summary.maximum = errors.back();
  return summary;
}

}  // namespace loopgrid
