#include "frontend/matching/matching_options.h"

#include "backend/base/option_check.h"

namespace loopgrid {

void NormalOptions::Validate() const {
  RequireBetween("neighbours", neighbours, 1, 1000);
  RequireBetween("max_gap", max_gap, 0.001, 1000.0);
  RequireBetween("max_reach", max_reach, 0.001, 1000.0);
  RequireBetween("max_flatness", max_flatness, 0.0, 1.0);
  RequireBetween("max_thickness", max_thickness, 0.0, 100.0);
}

void NoReturnOptions::Validate() const {
  normals.Validate();
  RequireBetween("min_range", min_range, 0.0, 100.0);
  RequireBetween("max_range", max_range, 0.1, 1000.0);
  RequireBetween("bin_width", bin_width, 0.01, 10.0);
  RequireBetween("bins_below", bins_below, 1, 1000);
  RequireBetween("heap_factor", heap_factor, 0, 1000000);
  RequireBetween("min_heap", min_heap, 0, 1000000);
  RequireBetween("min_heap_range", min_heap_range, 0.0, 1000.0);
}

void RefinerOptions::Validate() const {
  RequireBetween("max_iterations", max_iterations, 1, 1000);
  RequireBetween("first_scale", first_scale, 0.001, 10.0);
  RequireBetween("last_scale", last_scale, 0.001, 10.0);
  RequireBetween("range_sigma", range_sigma, 0.0001, 10.0);
  RequireBetween("normal_sigma", normal_sigma, 0.0, 1.0);
}

void MatchCovarianceOptions::Validate() const {
  RequireBetween("hit_log_likelihood", hit_log_likelihood, 0.01, 1000.0);
  RequireBetween("narrowest", narrowest, 0.0001, 10.0);
  RequireBetween("widest", widest, 0.0001, 100.0);
  RequireBetween("unknown_translation", unknown_translation, 0.1, 1e6);
  RequireBetween("unknown_rotation", unknown_rotation, 0.1, 100.0);
}

void VisibilityOptions::Validate() const {
  RequireBetween("tolerance", tolerance, 0.0, 10.0);
  RequireBetween("nearest", nearest, 0.0, 100.0);
  RequireBetween("farthest", farthest, 0.1, 1000.0);
  RequireBetween("min_facing", min_facing, 0.0, 1.0);
}

}  // namespace loopgrid
