#include "apps/replay/replay_options.h"

#include <fmt/format.h>

#include "apps/net/host_port.h"
#include "backend/base/error.h"

namespace loopgrid {

void ReplayOptions::Validate() const {
  constexpr double kSlowest = 1e-6;
  constexpr double kFastest = 1e6;
  // This form of the test also refuses NaN.
  if (speed != 0.0 && !(speed >= kSlowest && speed <= kFastest)) {
    throw Error(ErrorCode::kUsage,
                fmt::format("--speed is {}, expected 0 or {} to {}", speed, kSlowest, kFastest));
  }
  if (loop < 0) {
    throw Error(ErrorCode::kUsage, fmt::format("--loop is {}, expected 0 or more", loop));
  }
  if (from_line < 1) {
    throw Error(ErrorCode::kUsage, fmt::format("--from-line is {}, expected 1 or more", from_line));
  }
  if (!to.empty() && ParseHostPort(to).port == 0) {
    throw Error(ErrorCode::kUsage, "--to is " + to + ", expected a port from 1 to 65535");
  }
}

}  // namespace loopgrid
