#include "mapping/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace loopgrid {
namespace {

constexpr double kPadding = 0.03;  // of the range, on both sides

// A few rounding errors outside still count as inside.
constexpr double kSlack = 1e-9;

}  // namespace

double RoundDown(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (double digit : {5.0, 2.0}) {
    if (digit * power <= value) return digit * power;
  }
  return power;
}

Axis::Axis(double lowest, double highest, bool is_logarithmic)
    : is_logarithmic_(is_logarithmic),
      begin_(is_logarithmic ? std::log10(lowest) : lowest),
      end_(is_logarithmic ? std::log10(highest) : highest) {
  if (!(end_ > begin_)) {
    const double room = is_logarithmic ? 0.5 : std::max(0.5, 0.5 * std::abs(begin_));
    begin_ -= room;
    end_ += room;
  }
  const double padding = kPadding * (end_ - begin_);
  begin_ -= padding;
  end_ += padding;
}

double Axis::Position(double value) const {
  if (!is_logarithmic_) return (value - begin_) / (end_ - begin_);
  if (!(value > 0.0)) return 0.0;
  return std::max(0.0, (std::log10(value) - begin_) / (end_ - begin_));
}

std::vector<AxisTick> Axis::Ticks(int count) const {
  return is_logarithmic_ ? LogarithmicTicks(count) : LinearTicks(count);
}

std::vector<AxisTick> Axis::LinearTicks(int count) const {
  const double step = RoundDown((end_ - begin_) / count * 2.0);
  std::vector<AxisTick> ticks;
  const double first = std::ceil(begin_ / step - kSlack);
  const double last = std::floor(end_ / step + kSlack);
  for (double k = first; k <= last; ++k) {
    // Adding 0.0 turns -0 into 0. Six digits hide the rounding error of 3 * 0.1.
    ticks.push_back({k * step + 0.0, fmt::format("{:.6g}", k * step + 0.0), ""});
  }
  return ticks;
}

std::vector<AxisTick> Axis::LogarithmicTicks(int count) const {
  const double decades = end_ - begin_;
  const int stride = std::max(1, static_cast<int>(std::ceil(decades / count)));
  const bool labels_between = decades < 2.0;
  std::vector<AxisTick> ticks;
  for (int power = static_cast<int>(std::floor(begin_)); power <= end_; ++power) {
    for (int digit = 1; digit < 10; ++digit) {
      const double logarithm = power + std::log10(digit);
      if (logarithm < begin_ - kSlack || logarithm > end_ + kSlack) continue;
      const double value = digit * std::pow(10.0, power);
      if (labels_between) {
        const bool is_round = digit == 1 || digit == 2 || digit == 5;
        ticks.push_back({value, is_round ? fmt::format("{:g}", value) : "", ""});
      } else if (digit == 1 && power % stride == 0) {
        ticks.push_back({value, "10", std::to_string(power)});
      } else if (stride == 1 || digit == 1) {
        ticks.push_back({value, "", ""});
      }
    }
  }
  return ticks;
}

}  // namespace loopgrid
