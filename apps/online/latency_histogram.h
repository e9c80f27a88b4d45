#pragma once

#include <array>
#include <cstdint>

namespace loopgrid {

/// Durations, counted in bins that are 2 % wide, so that any number of them takes the same memory.
class LatencyHistogram {
 public:
  void Add(double seconds);

  /// The duration that the share `quantile` (0..1) of all does not exceed, seconds, to 2 %; 0 if
  /// there is none.
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
