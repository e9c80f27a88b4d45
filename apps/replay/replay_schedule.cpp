#include "apps/replay/replay_schedule.h"

#include <utility>

namespace loopgrid {

double ReplaySchedule::Due(double timestamp) {
  const double step = timestamp - std::exchange(last_timestamp_, timestamp);
  const bool waits = std::exchange(begun_, true) && step > 0.0 && step <= kLongestGap;
  if (waits && speed_ > 0.0) due_ += step / speed_;
  return due_;
}

}  // namespace loopgrid
