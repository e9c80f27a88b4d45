#include "frontend/tracking/tracking_options.h"

#include "backend/base/option_check.h"

namespace loopgrid {

void OdometryNoise::Validate() const {
  RequireBetween("translation_per_metre", translation_per_metre, 0.0, 100.0);
  RequireBetween("translation_per_radian", translation_per_radian, 0.0, 100.0);
  RequireBetween("rotation_per_metre", rotation_per_metre, 0.0, 100.0);
  RequireBetween("rotation_per_radian", rotation_per_radian, 0.0, 100.0);
  RequireBetween("translation_floor", translation_floor, 1e-4, 100.0);
  RequireBetween("rotation_floor", rotation_floor, 1e-4, 3.0);
}

void TrackerOptions::Validate() const {
  odometry.Validate();
  refiner.Validate();
  covariance.Validate();
  RequireBetween("table_resolution", table_resolution, 0.01, 1.0);
  RequireBetween("table_sigma", table_sigma, 0.001, 1.0);
  RequireBetween("map_radius", map_radius, 0.1, 1000.0);
  RequireBetween("window_sigmas", window_sigmas, 0.1, 100.0);
  RequireBetween("window_margin", window_margin, 0.0, 10.0);
  RequireBetween("window_angle_margin", window_angle_margin, 0.0, 3.0);
  RequireBetween("widest_rotation", widest_rotation, 0.01, 3.0);
  RequireBetween("prior_weight", prior_weight, 0.0, 1.0);
  RequireBetween("min_score", min_score, 0.0, 1.0);
  RequireBetween("min_inlier_share", min_inlier_share, 0.0, 1.0);
  RequireBetween("min_points", min_points, 1, 1000000);
  RequireBetween("lost_reach", lost_reach, 0.05, 100.0);
  RequireBetween("lost_min_score", lost_min_score, 0.0, 1.0);
  RequireBetween("lost_min_inlier_share", lost_min_inlier_share, 0.0, 1.0);
  RequireBetween("lost_max_second", lost_max_second, 0.0, 1.0);
  RequireBetween("lost_peak_distance", lost_peak_distance, 0.0, 100.0);
  RequireBetween("lost_peak_angle", lost_peak_angle, 0.0, 3.0);
}

void KnownSpaceOptions::Validate() const {
  RequireBetween("distance", distance, 0.0, 1000.0);
  RequireBetween("passes", passes, 1, 1000000);
  RequireBetween("same_pass", same_pass, 0, 1000000);
  RequireBetween("recent_nodes", recent_nodes, 1, 1000000);
  RequireBetween("recent_path", recent_path, 0.0, 1e6);
  RequireBetween("closed_within", closed_within, 0, 1000000);
  RequireBetween("map_nodes", map_nodes, 1, 1000000);
  RequireBetween("min_inlier_share", min_inlier_share, 0.0, 1.0);
  RequireBetween("max_shift", max_shift, 0.0, 100.0);
  RequireBetween("max_turn", max_turn, 0.0, 3.14);
}

}  // namespace loopgrid
