#pragma once

#include <algorithm>

namespace loopgrid {

/// The pauses between attempts at something that keeps failing: each is longer than the one before.
class BackOff {
 public:
  /// Both in seconds.
  BackOff(double first, double longest) : first_(first), longest_(longest), next_(first) {}

  /// The pause before the next attempt, seconds: twice the last one, up to the longest.
  double Next() {
    const double pause = std::min(next_, longest_);
    next_ = 2.0 * pause;
    return pause;
  }

  /// Call after a successful attempt: the next pause is the first one again.
  void Reset() { next_ = first_; }

 private:
  double first_;
  double longest_;
  double next_;
};

}  // namespace loopgrid
