#include "backend/solve/optimizer_options.h"

#include <fmt/format.h>

#include <cmath>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

constexpr int kMostThreads = 1024;

void RequireAtLeast(double bound, const char* field, double value) {
  if (std::isfinite(value) && value >= bound) return;
  throw Error(ErrorCode::kUsage,
              fmt::format("{} is {}, expected at least {}", field, value, bound));
}

}  // namespace

void OptimizerOptions::Validate() const {
  RequireAtLeast(0.0, "max_iterations", max_iterations);
  RequireAtLeast(0.0, "relative_decrease", relative_decrease);
  RequireAtLeast(0.0, "absolute_decrease", absolute_decrease);
  if (threads < 1 || threads > kMostThreads) {
    throw Error(ErrorCode::kUsage,
                fmt::format("threads is {}, expected 1 to {}", threads, kMostThreads));
  }
  loss.Validate();
  if (graduated && loss.kind != LossKind::kGemanMcClure) {
    throw Error(ErrorCode::kUsage, "graduated is set, expected a Geman-McClure loss with it");
  }
}

}  // namespace loopgrid
