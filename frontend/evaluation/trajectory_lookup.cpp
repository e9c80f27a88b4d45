#include "frontend/evaluation/trajectory_lookup.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace loopgrid {

TrajectoryLookup::TrajectoryLookup(const Trajectory& trajectory) : trajectory_(trajectory) {
  by_time_.reserve(trajectory.size());
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    by_time_.push_back({trajectory[i].timestamp, i});
  }
  std::stable_sort(by_time_.begin(), by_time_.end(),
                   [](const Entry& a, const Entry& b) { return a.timestamp < b.timestamp; });
}

TrajectoryLookup::Iterator TrajectoryLookup::FirstNotBefore(double timestamp) const {
  return std::lower_bound(by_time_.begin(), by_time_.end(), timestamp,
                          [](const Entry& entry, double time) { return entry.timestamp < time; });
}

std::optional<std::size_t> TrajectoryLookup::Nearest(double timestamp, double tolerance) const {
  std::optional<std::size_t> nearest;
  double distance = tolerance;
  const auto consider = [&](Iterator entry) {
    const double difference = std::abs(entry->timestamp - timestamp);
    const bool earlier_in_file = !nearest || entry->index < *nearest;
    if (difference < distance || (difference == distance && earlier_in_file)) {
      nearest = entry->index;
      distance = difference;
    }
  };
  const Iterator after = FirstNotBefore(timestamp);
  if (after != by_time_.end()) consider(after);
  if (after != by_time_.begin()) consider(FirstNotBefore(std::prev(after)->timestamp));
  return nearest;
}

std::optional<SE2> TrajectoryLookup::Interpolate(double timestamp) const {
  const Iterator after = FirstNotBefore(timestamp);
  if (after == by_time_.end()) return std::nullopt;
  const SE2& next = trajectory_[after->index].pose;
  if (after->timestamp == timestamp) return next;
  if (after == by_time_.begin()) return std::nullopt;
  const Iterator before = std::prev(after);
  const SE2& last = trajectory_[before->index].pose;
  const double share = (timestamp - before->timestamp) / (after->timestamp - before->timestamp);
  const Eigen::Vector2d position =
      last.translation() + share * (next.translation() - last.translation());
  return SE2(position.x(), position.y(),
             last.theta() + share * NormalizeAngle(next.theta() - last.theta()));
}

}  // namespace loopgrid
