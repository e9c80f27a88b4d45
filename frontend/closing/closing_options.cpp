#include "frontend/closing/closing_options.h"

#include "backend/base/option_check.h"

namespace loopgrid {

void ClosureMatcherOptions::Validate() const {
  refiner.Validate();
  covariance.Validate();
  visibility.Validate();
  RequireBetween("fine_resolution", fine_resolution, 0.01, 1.0);
  RequireBetween("coarse_resolution", coarse_resolution, 0.01, 1.0);
  RequireBetween("fine_sigma", fine_sigma, 0.001, 1.0);
  RequireBetween("coarse_sigma", coarse_sigma, 0.001, 1.0);
  RequireBetween("coarse_from", coarse_from, 0.0, 1e6);
  RequireBetween("coarse_points", static_cast<double>(coarse_points), 1.0, 1e6);
  RequireBetween("widest", widest, 0.0, 1000.0);
  RequireBetween("min_score", min_score, 0.0, 1.0);
  RequireBetween("min_inlier_share", min_inlier_share, 0.0, 1.0);
  RequireBetween("peak_distance", peak_distance, 0.0, 1000.0);
  RequireBetween("peak_angle", peak_angle, 0.0, 3.14);
}

void ClosureGateOptions::Validate() const {
  RequireBetween("gate_sigmas", gate_sigmas, 0.1, 100.0);
  RequireBetween("view_distance", view_distance, 0.0, 1000.0);
  RequireBetween("recent_nodes", recent_nodes, 1, 1000000);
  RequireBetween("recent_path", recent_path, 0.0, 1e6);
  RequireBetween("same_pass", same_pass, 0, 1000000);
  RequireBetween("window_margin", window_margin, 0.0, 100.0);
  RequireBetween("window_angle_margin", window_angle_margin, 0.0, 3.14);
  RequireBetween("max_candidates", max_candidates, 0, 1000000);
}

void PlaceFinderOptions::Validate() const {
  RequireBetween("spacing", spacing, 0.1, 1000.0);
  RequireBetween("half_width", half_width, 0.1, 1000.0);
  RequireBetween("peak_distance", peak_distance, 0.0, 1000.0);
  RequireBetween("min_score", min_score, 0.0, 1.0);
  RequireBetween("min_inlier_share", min_inlier_share, 0.0, 1.0);
  RequireBetween("min_share", min_share, 0.0, 1.0);
}

void ClosureFinderOptions::Validate() const {
  gate.Validate();
  matcher.Validate();
  place_finder.Validate();
  RequireBetween("map_path", map_path, 0.0, 1e6);
  RequireBetween("map_radius", map_radius, 0.1, 1e6);
  RequireBetween("surroundings_path", surroundings_path, 0.0, 1e6);
  RequireBetween("surroundings_from", surroundings_from, 0.0, 1e6);
  RequireBetween("max_second_share", max_second_share, 0.0, 1.0);
  RequireBetween("max_denied_share", max_denied_share, 0.0, 1.0);
  RequireBetween("max_sigma", max_sigma, 0.001, 1e6);
  RequireBetween("places_a_node", places_a_node, 1, 1000000);
  RequireBetween("max_node_steps", max_node_steps, 1, 1000000);
  RequireBetween("eager_nodes", eager_nodes, 0, 1000000);
}

void ClosureVerifierOptions::Validate() const {
  RequireBetween("min_agreeing", min_agreeing, 1, 1000000);
  RequireBetween("min_agreeing_anywhere", min_agreeing_anywhere, 1, 1000000);
  RequireBetween("min_agreeing_path", min_agreeing_path, 0.0, 1e6);
  RequireBetween("min_separation", min_separation, 0.0, 1e6);
  RequireBetween("horizon_nodes", horizon_nodes, 0, 1000000);
  RequireBetween("sigma_translation", sigma_translation, 1e-6, 1e3);
  RequireBetween("sigma_translation_per_metre", sigma_translation_per_metre, 0.0, 10.0);
  RequireBetween("sigma_rotation", sigma_rotation, 1e-6, 3.14);
  RequireBetween("sigma_rotation_per_metre", sigma_rotation_per_metre, 0.0, 3.14);
  RequireBetween("farthest_path", farthest_path, 0.0, 1e6);
}

void ClosureGraphOptions::Validate() const {
  RequireBetween("max_chi2", max_chi2, 1e-6, 1e12);
  loss.Validate();
  RequireBetween("max_iterations", max_iterations, 1, 1000000);
  RequireBetween("relative_decrease", relative_decrease, 0.0, 1.0);
  RequireBetween("absolute_decrease", absolute_decrease, 0.0, 1e12);
  RequireBetween("last_max_iterations", last_max_iterations, 1, 1000000);
  RequireBetween("last_relative_decrease", last_relative_decrease, 0.0, 1.0);
  RequireBetween("last_absolute_decrease", last_absolute_decrease, 0.0, 1e12);
}

void NeighbourLinkerOptions::Validate() const {
  matcher.Validate();
  RequireBetween("distance", distance, 0.0, 1000.0);
  RequireBetween("same_pass", same_pass, 0, 1000000);
  RequireBetween("already_linked", already_linked, 0, 1000000);
  RequireBetween("map_path", map_path, 0.0, 1e6);
  RequireBetween("map_radius", map_radius, 0.1, 1e6);
  RequireBetween("window.x", window.x, 0.0, 1000.0);
  RequireBetween("window.y", window.y, 0.0, 1000.0);
  RequireBetween("window.rotation", window.rotation, 0.0, 3.14);
  RequireBetween("max_denied_share", max_denied_share, 0.0, 1.0);
  RequireBetween("max_shift", max_shift, 0.0, 1000.0);
  RequireBetween("max_turn", max_turn, 0.0, 3.14);
}

void ClosingOptions::Validate() const {
  finder.Validate();
  verifier.Validate();
  graph.Validate();
  linker.Validate();
}

}  // namespace loopgrid
