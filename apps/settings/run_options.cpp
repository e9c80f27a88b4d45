#include "apps/settings/run_options.h"

#include <fmt/format.h>

#include "backend/base/error.h"

namespace loopgrid {

void RunOptions::Validate() const {
  constexpr double kFinest = 0.01;
  constexpr double kCoarsest = 1.0;
  // Written so that NaN does not pass.
  if (!(resolution >= kFinest && resolution <= kCoarsest)) {
    throw Error(ErrorCode::kUsage,
                fmt::format("resolution is {}, expected {} to {}", resolution, kFinest, kCoarsest));
  }
  slam.Validate();
}

}  // namespace loopgrid
