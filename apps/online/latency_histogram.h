#pragma once

#include <array>
#include <cstdint>

namespace loopgrid {

/// Counts durations in bins that are 2 % wide. The memory does not grow with their number.
class LatencyHistogram {
 public:
  void Add(double seconds);

  /// The quantile of the durations (`quantile` 0..1), seconds, exact to 2 %; 0 if there are none.
  double Quantile(double quantile) const;

  double max() const { return max_; }
  std::int64_t count() const { return count_; }

 private:
  static constexpr std::size_t kBins = 1100;  // a microsecond to more than 30 minutes

  std::array<std::int64_t, kBins> bins_{};
  std::int64_t count_ = 0;
  double max_ = 0.0;
};

}  // namespace loopgrid
