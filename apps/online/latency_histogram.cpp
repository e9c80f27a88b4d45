#include "apps/online/latency_histogram.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace loopgrid {
namespace {

constexpr double kShortest = 1e-6;  // seconds, the upper end of bin 0
constexpr double kRatio = 1.02;     // between the ends of two neighbouring bins

}  // namespace

void LatencyHistogram::Add(double seconds) {
  const double bin =
      std::ceil(std::log(std::max(seconds, kShortest) / kShortest) / std::log(kRatio));
  ++bins_[static_cast<std::size_t>(std::min(bin, kBins - 1.0))];
  ++count_;
  max_ = std::max(max_, seconds);
}

double LatencyHistogram::Quantile(double quantile) const {
  const double wanted = quantile * static_cast<double>(count_);
  std::int64_t passed = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    passed += bins_[bin];
    if (passed == 0 || static_cast<double>(passed) < wanted) continue;
    return std::min(kShortest * std::pow(kRatio, static_cast<double>(bin)), max_);
  }
  return max_;
}

}  // namespace loopgrid
