#pragma once

#include <cstddef>

#include "backend/graph/robust_loss.h"
#include "frontend/matching/matching_options.h"

namespace loopgrid {

/// How the scan of a new node is matched with the map around an old one.
struct ClosureMatcherOptions {
  RefinerOptions refiner{};
  MatchCovarianceOptions covariance{};
  VisibilityOptions visibility{};
  double fine_resolution = 0.05;    ///< cell of the likelihood table for small windows, metres
  double coarse_resolution = 0.10;  ///< the same for large windows, metres
  double fine_sigma = 0.07;         ///< spread of a hit around a surface in small windows, metres
  double coarse_sigma = 0.10;       ///< the same for large windows, metres
  double coarse_from = 1.0;         ///< windows with at least this half width are large, metres
  std::size_t coarse_points = 300;  ///< searched with in large windows at most
  double widest = 25.0;             ///< half width that is searched at most, metres
  double min_score = 0.5;           ///< of the correlative search, 0..1
  double min_inlier_share = 0.5;    ///< of the refined match, 0..1
  double peak_distance = 0.8;       ///< a second peak is at least this far away, metres,
  double peak_angle = 0.35;         ///< ... or turned by this much, radians

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

/// Which old nodes a new one is matched with: the 3 sigma gate.
struct ClosureGateOptions {
  double gate_sigmas = 3.0;     ///< old nodes this close to the current pose are candidates
  double view_distance = 4.0;   ///< nodes that see the same place may be this far apart, metres
  int recent_nodes = 20;        ///< the newest nodes are not "old": tracking matches with them
  double recent_path = 10.0;    ///< nor are nodes less than this much travel ago, metres
  int same_pass = 5;            ///< candidates at most this many nodes apart are of one pass
  double window_margin = 0.15;  ///< added to the search window on every side, metres
  double window_angle_margin = 0.05;  ///< added to the searched rotation on either side, radians
  int max_candidates = 3;             ///< passes that are matched for each node, at most

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

/// How the place of a robot is searched for if it may be anywhere.
struct PlaceFinderOptions {
  double spacing = 5.0;  ///< between the middles of the windows searched, metres
  double half_width =
      7.0;  ///< of such a window, metres; large because the robot need not be near a node
  double peak_distance = 0.8;      ///< two finds this close are the same place, metres
  double min_score = 0.65;         ///< of the search, 0..1; high because many rooms look the same
  double min_inlier_share = 0.75;  ///< of the refined match, 0..1
  double min_share = 0.85;  ///< places with less than this share of the best score are left out

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

/// Which matches are proposed as closures.
struct ClosureFinderOptions {
  ClosureGateOptions gate{};
  ClosureMatcherOptions matcher{};
  PlaceFinderOptions place_finder{};
  double map_path = 10.0;    ///< nodes this much travel before and after make the map, metres
  double map_radius = 25.0;  ///< surfaces farther from the old node are left out, metres
  double surroundings_path =
      4.0;  ///< nodes of this much travel are searched for together in large windows, metres
  double surroundings_from = 1.0;  ///< windows with at least this half width are large, metres
  double max_second_share = 0.92;  ///< a second peak this close to the best makes it ambiguous
  double max_denied_share = 0.3;   ///< of the walls in view that beams may go through, 0..1
  double max_sigma = 0.5;  ///< of the position, in the match's least certain direction, metres

  /// If the robot may be anywhere, the whole map is searched. The time that this takes grows with
  /// the map, so it is done at every n-th node only, n = places / `places_a_node`.
  int places_a_node = 40;
  int max_node_steps = 4;  ///< n is at most this
  int eager_nodes = 40;    ///< after this many nodes without a find n is `max_node_steps`

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

/// Which proposed closures are accepted.
struct ClosureVerifierOptions {
  int min_agreeing = 3;             ///< closures that must agree before they are accepted
  int min_agreeing_anywhere = 4;    ///< the same, for a robot that may be anywhere
  double min_agreeing_path = 1.0;   ///< they must come from at least this much travel, metres
  double min_separation = 2.0;      ///< of the consistent set, see ConsistentSet
  int horizon_nodes = 20;           ///< closures older than this many nodes do not count
  double sigma_translation = 0.02;  ///< of the path between two nodes, metres, at least
  double sigma_translation_per_metre = 0.01;  ///< added for every metre of it
  double sigma_rotation = 0.005;              ///< of that path, radians, at least
  double sigma_rotation_per_metre = 0.002;    ///< added for every metre of it
  double farthest_path =
      50.0;  ///< longer paths count as this long, metres: the graph is more certain

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

/// When closures are put into the graph and taken out again.
struct ClosureGraphOptions {
  double max_chi2 = 25.0;  ///< of a closure after optimisation, at most: five sigmas
  RobustLoss loss{LossKind::kHuber, 3.0};  ///< of closures

  // See OptimizerOptions. These two are for each optimisation while the graph grows.
  int max_iterations = 30;
  double relative_decrease = 1e-4;
  double absolute_decrease = 1e-3;
  // These two are for the optimisation that ends the run.
  int last_max_iterations = 100;
  double last_relative_decrease = 1e-8;
  double last_absolute_decrease = 1e-9;

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

/// How neighbours are linked when the run ends.
struct NeighbourLinkerOptions {
  ClosureMatcherOptions matcher{};
  double distance = 3.0;     ///< nodes this close may see the same surfaces, metres
  int same_pass = 10;        ///< nodes at most this many apart belong to one pass
  int already_linked = 3;    ///< no link where a closure is at most this many nodes away
  double map_path = 5.0;     ///< travel before and after a node that makes its map, metres
  double map_radius = 25.0;  ///< surfaces farther from the node are left out, metres
  SearchWindow window{0.1, 0.1, 0.03};  ///< around the pose that the graph gives
  double max_denied_share = 0.2;        ///< see Visibility, 0..1
  double max_shift =
      0.2;  ///< a match farther than this from the pose in the graph is left out, metres
  double max_turn = 0.06;  ///< the same for its angle, radians

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

/// The options of all that happens to a node after tracking.
struct ClosingOptions {
  ClosureFinderOptions finder{};
  ClosureVerifierOptions verifier{};
  ClosureGraphOptions graph{};
  NeighbourLinkerOptions linker{};

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

}  // namespace loopgrid
