#include "apps/online/online_options.h"

#include <fmt/format.h>

#include "backend/base/error.h"

namespace loopgrid {

void OnlineOptions::Validate() const {
  constexpr double kShortestInterval = 0.01;
  constexpr double kLongestInterval = 86400.0;
  const int sources =
      (follow.empty() ? 0 : 1) + (listen.empty() ? 0 : 1) + (connect.empty() ? 0 : 1);
  if (sources > 1) {
    throw Error(ErrorCode::kUsage, "follow, listen and connect: more than one is given");
  }
  if (once && listen.empty() && connect.empty()) {
    throw Error(ErrorCode::kUsage, "once is for listen and connect");
  }
  if (run.out.empty() && resume.empty()) {
    throw Error(ErrorCode::kUsage, "out or resume is missing: the folder of the session");
  }
  if (!run.out.empty() && !resume.empty()) {
    throw Error(ErrorCode::kUsage, "out and resume: the resumed session has its folder");
  }
  if (!continued.empty() && !resume.empty()) {
    throw Error(ErrorCode::kUsage, "continue and resume: a resumed session is no new one");
  }
  // Written so that NaN does not pass.
  if (!(interval >= kShortestInterval && interval <= kLongestInterval)) {
    throw Error(ErrorCode::kUsage, fmt::format("interval is {}, expected {} to {}", interval,
                                               kShortestInterval, kLongestInterval));
  }
  if (threads < 1) {
    throw Error(ErrorCode::kUsage, fmt::format("threads is {}, expected at least 1", threads));
  }
  run.Validate();
}

}  // namespace loopgrid
