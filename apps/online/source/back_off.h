#pragma once

#include <algorithm>

namespace loopgrid {

/// How long to wait before each attempt at something that keeps failing: ever longer.
class BackOff {
 public:
  /// Seconds.
  BackOff(double first, double longest) : first_(first), longest_(longest), next_(first) {}

  /// Before the next attempt, seconds: twice as long as before the last one, up to the longest.
  double Next() {
    const double pause = std::min(next_, longest_);
    next_ = 2.0 * pause;
    return pause;
  }

  /// It has worked.
  void Reset() { next_ = first_; }

 private:
  double first_;
  double longest_;
  double next_;
};

}  // namespace loopgrid
