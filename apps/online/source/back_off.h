#pragma once

#include <algorithm>

namespace loopgrid {

/// How long to wait before each attempt at something that keeps failing: ever longer.
class BackOff {
 public:
  /// Both in seconds.
  BackOff(double first, double longest) : first_(first), longest_(longest), next_(first) {}

  /// How long to wait before the next attempt, seconds: twice as long as the last time, up to the
  /// longest.
  double Next() {
    const double pause = std::min(next_, longest_);
    next_ = 2.0 * pause;
    return pause;
  }

  /// An attempt has worked: begins again with the first pause.
  void Reset() { next_ = first_; }

 private:
  double first_;
  double longest_;
  double next_;
};

}  // namespace loopgrid
