#include "frontend/slam/slam_options.h"

#include "backend/base/option_check.h"

namespace loopgrid {

void StandstillOptions::Validate() const {
  RequireBetween("distance", distance, 0.0, 100.0);
  RequireBetween("angle", angle, 0.0, 3.14);
  RequireBetween("max_scans", max_scans, 1, 1000000);
}

void CarriedOptions::Validate() const {
  RequireBetween("distance", distance, 0.1, 1e6);
  RequireBetween("farthest", farthest, 0.1, 1e6);
}

void SlamOptions::Validate() const {
  RequireBetween("node_distance", node_distance, kLeastNodeDistance, kMostNodeDistance);
  RequireBetween("node_angle", node_angle, kLeastNodeAngle, kMostNodeAngle);
  RequireBetween("tracked_nodes", tracked_nodes, 1, 1000000);
  RequireBetween("unmatched_factor", unmatched_factor, 1.0, 1e6);
  RequireBetween("update_lag", update_lag, 0, 1000000);
  RequireBetween("threads", threads, 1, 1024);
  no_return.Validate();
  tracker.Validate();
  known_space.Validate();
  closing.Validate();
  standstill.Validate();
  carried.Validate();
}

}  // namespace loopgrid
