#pragma once

namespace loopgrid {

/// The search window: half widths around the initial pose, along the map's axes.
struct SearchWindow {
  double x = 0.3;         ///< metres
  double y = 0.3;         ///< metres
  double rotation = 0.2;  ///< radians
};

/// Which hits lie on a straight piece of surface, so that a normal can be computed.
struct NormalOptions {
  int neighbours = 3;      ///< hits on either side that the line is fitted to, at most
  double max_gap = 1.0;    ///< between consecutive hits of one surface, metres
  double max_reach = 0.6;  ///< from the hit to a neighbour, metres; the nearest one always counts
  double max_flatness = 0.15;   ///< spread across the line over spread along it
  double max_thickness = 0.05;  ///< spread across the line, metres

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

/// The no-return rule: which readings are hits, and which mean that the beam met nothing. The
/// no-return value of a laser is found as a heap in the histogram of all readings so far: its two
/// topmost bins, if they have enough readings and many more than the bins below them.
struct NoReturnOptions {
  double min_range = 0.05;      ///< shorter readings mean "error", metres
  double max_range = 40.0;      ///< longer readings are too rare to help, metres
  double bin_width = 0.5;       ///< of the histogram of readings, metres
  int bins_below = 4;           ///< bins below the heap that it is compared with
  int heap_factor = 2;          ///< a heap has more than so many times the readings of those bins
  int min_heap = 8;             ///< ... and more readings than this
  double min_heap_range = 4.0;  ///< a heap nearer than this is taken for walls, metres
  NormalOptions normals{};

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

struct RefinerOptions {
  int max_iterations = 10;
  double first_scale = 0.15;  ///< residual at which a hit has half its influence at first, metres
  double last_scale = 0.05;   ///< the same in the last iterations, metres
  double range_sigma = 0.03;  ///< standard deviation of one hit across the surface, metres
  double normal_sigma = 0.1;  ///< standard deviation of a normal's direction, radians

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

struct MatchCovarianceOptions {
  /// Log-likelihood of a perfect hit relative to that of a miss. The errors of neighbouring beams
  /// are not independent. The value was chosen so that chi2 of closed loops is near its
  /// expectation.
  double hit_log_likelihood = 4.0;
  /// The lattice is made for standard deviations of at least this size, metres. A finer lattice
  /// would lie within one or two cells of the table, where the score is flat, and give too little
  /// information.
  double narrowest = 0.02;
  double widest = 0.4;  ///< the largest one, metres; a match with a larger one is unknown
  double unknown_translation = 20.0;  ///< standard deviation that stands for "unknown", metres
  double unknown_rotation = 3.0;      ///< the same in radians

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

struct VisibilityOptions {
  double tolerance = 0.4;   ///< between a surface and the end of a beam that confirms it, metres
  double nearest = 0.3;     ///< closer surfaces may be parts of the robot, metres
  double farthest = 12.0;   ///< farther surfaces are not compared: a small error of the angle makes
                            ///< beams miss them, metres
  double min_facing = 0.3;  ///< least cosine between beam and normal: a beam that grazes a wall
                            ///< passes it within the tolerance

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

}  // namespace loopgrid
