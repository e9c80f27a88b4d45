#pragma once

#include <string>
#include <vector>

namespace loopgrid {

/// The largest of 1, 2 or 5 times a power of ten that is not above `value`, which is positive.
double RoundDown(double value);

struct AxisTick {
  double value = 0.0;
  std::string label;     ///< empty for the smaller ticks
  std::string exponent;  ///< written raised behind the label, as in 10^3
};

/// An axis of a plot: which values it shows, and where on a scale from 0 to 1.
class Axis {
 public:
  /// Shows lowest..highest; a single value gets room on both sides. A logarithmic axis needs
  /// lowest > 0.
  Axis(double lowest, double highest, bool is_logarithmic);

  bool is_logarithmic() const { return is_logarithmic_; }

  /// Where a value is: 0 at the lower end, 1 at the upper one. Values below the lower end of a
  /// logarithmic axis are at 0.
  double Position(double value) const;

  /// About `count` labelled ticks at round values, and smaller ones between them.
  std::vector<AxisTick> Ticks(int count) const;

 private:
  std::vector<AxisTick> LinearTicks(int count) const;
  std::vector<AxisTick> LogarithmicTicks(int count) const;

  bool is_logarithmic_;
  double begin_;  // of the values, or of their logarithms
  double end_;
};

}  // namespace loopgrid
