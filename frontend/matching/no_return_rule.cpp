#include "frontend/matching/no_return_rule.h"

#include <algorithm>
#include <cmath>

namespace loopgrid {
namespace {

constexpr double kMaxReading = 1000.0;  // metres; longer readings go into the last bin

}  // namespace

void NoReturnRule::Learn(const LaserScan& scan) {
  for (float range : scan.ranges) {
    if (!std::isfinite(range) || range < 0.0F) continue;
    const double clamped = std::min(static_cast<double>(range), kMaxReading);
    const auto bin = static_cast<std::size_t>(clamped / options_.bin_width);
    if (bin >= histogram_.size()) histogram_.resize(bin + 1, 0);
    ++histogram_[bin];
  }
  // Readings of a no-return value on the border of two bins (50.99, 51.01) fall into both.
  const int bins = static_cast<int>(histogram_.size());
  if (bins < options_.bins_below + 2) return;
  const auto at = [&](int bin) { return histogram_[static_cast<std::size_t>(bin)]; };
  const int heap = at(bins - 1) + at(bins - 2);
  int below = 0;
  for (int k = 0; k < options_.bins_below; ++k) below += bins - 3 - k >= 0 ? at(bins - 3 - k) : 0;
  const double heap_begin = options_.bin_width * (bins - 2);
  const bool is_heap = heap_begin >= options_.min_heap_range && heap > options_.min_heap &&
                       heap > options_.heap_factor * below;
  double limit = is_heap ? heap_begin : options_.max_range;
  if (scan.max_range > 1.0) limit = std::min(limit, scan.max_range);
  usable_range_ = std::min(limit, options_.max_range);
}

PointScan NoReturnRule::Interpret(const LaserScan& scan) {
  Learn(scan);
  return MakePointScan(scan, options_.min_range, usable_range_, options_.normals);
}

}  // namespace loopgrid
