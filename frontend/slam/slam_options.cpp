#include "frontend/slam/slam_options.h"

#include <fmt/format.h>

#include <cmath>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

void RequireBetween(const char* field, double value, double low, double high) {
  if (std::isfinite(value) && value >= low && value <= high) return;
  throw Error(ErrorCode::kUsage,
              fmt::format("{} is {}, expected {} to {}", field, value, low, high));
}

}  // namespace

void SlamOptions::Validate() const {
  RequireBetween("node_distance", node_distance, 0.05, 10.0);
  RequireBetween("node_angle", node_angle, 0.05, 3.0);
  RequireBetween("threads", threads, 1, 1024);
}

}  // namespace loopgrid
