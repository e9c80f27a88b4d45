#include "frontend/matching/sensor_model.h"

#include <algorithm>
#include <cmath>

namespace loopgrid {
namespace {

constexpr double kMinRange = 0.05;  // below: the sensor's way of saying "error"
constexpr double kFarthest = 40.0;  // beams this long hit too rarely to help
constexpr double kMaxReading = 1000.0;
constexpr double kBinWidth = 0.5;  // metres
// The no-return value makes a heap at the very top of the readings: more than twice as many as in
// the four bins (2 m) below it together, and more than a handful.
constexpr int kHeapNeighbours = 4;
constexpr int kHeapFactor = 2;
constexpr int kHeapLeast = 8;
constexpr double kHeapNearest = 4.0;  // metres; any laser sees as far: nearer heaps are rooms

}  // namespace

void SensorModel::Learn(const LaserScan& scan) {
  for (float range : scan.ranges) {
    if (!std::isfinite(range) || range < 0.0F) continue;
    const double clamped = std::min(static_cast<double>(range), kMaxReading);
    const auto bin = static_cast<std::size_t>(clamped / kBinWidth);
    if (bin >= histogram_.size()) histogram_.resize(bin + 1, 0);
    ++histogram_[bin];
  }
  // A no-return value on the border of two bins (50.99, 51.01) heaps up in both.
  const int bins = static_cast<int>(histogram_.size());
  if (bins < kHeapNeighbours + 2) return;
  const auto at = [&](int bin) { return histogram_[static_cast<std::size_t>(bin)]; };
  const int heap = at(bins - 1) + at(bins - 2);
  int below = 0;
  for (int k = 0; k < kHeapNeighbours; ++k) below += bins - 3 - k >= 0 ? at(bins - 3 - k) : 0;
  const double heap_begin = kBinWidth * (bins - 2);
  const bool is_heap =
      heap_begin >= kHeapNearest && heap > kHeapLeast && heap > kHeapFactor * below;
  double limit = is_heap ? heap_begin : kFarthest;
  if (scan.max_range > 1.0) limit = std::min(limit, scan.max_range);
  usable_range_ = std::min(limit, kFarthest);
}

PointScan SensorModel::Interpret(const LaserScan& scan) {
  Learn(scan);
  return MakePointScan(scan, kMinRange, usable_range_);
}

}  // namespace loopgrid
