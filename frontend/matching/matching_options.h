#pragma once

namespace loopgrid {

/// Where to look: half widths around the initial pose, in the map's axes.
struct SearchWindow {
  double x = 0.3;         ///< metres
  double y = 0.3;         ///< metres
  double rotation = 0.2;  ///< radians
};

/// Which hits lie on one line of surface and so have a normal.
struct NormalOptions {
  int neighbours = 3;      ///< hits on either side that the line is fitted to, at most
  double max_gap = 1.0;    ///< between consecutive hits of one surface, metres
  double max_reach = 0.6;  ///< from the hit to a neighbour, metres; the nearest one always counts
  double max_flatness = 0.15;   ///< spread across the line over spread along it
  double max_thickness = 0.05;  ///< spread across the line, metres

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

/// The no-return rule: which readings are hits, which say that nothing was met. The no-return value
/// of a laser shows as a heap of readings at the very top of all those seen so far: more than a
/// handful, and many more than in the bins below it.
struct SensorModelOptions {
  double min_range = 0.05;      ///< readings below say "error", metres
  double max_range = 40.0;      ///< beams this long hit too rarely to help, metres
  double bin_width = 0.5;       ///< of the histogram of readings, metres
  int bins_below = 4;           ///< bins below the heap that it is compared with
  int heap_factor = 2;          ///< a heap has more than so many times the readings of those bins
  int min_heap = 8;             ///< ... and more readings than this
  double min_heap_range = 4.0;  ///< a heap nearer than this is a room, metres
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
  /// Log-likelihood of a perfect hit over that of a miss. Below 1 because neighbouring beams err
  /// together: calibrated so that chi-square of closed loops comes out near its expectation.
  double hit_log_likelihood = 4.0;
  /// Least standard deviation that the lattice is laid for, metres. A finer lattice would lie
  /// within one or two cells of the table, where the score is flat and looks as if nothing were
  /// known.
  double narrowest = 0.02;
  double widest = 0.4;                ///< the largest one, metres: beyond, the match knows nothing
  double unknown_translation = 20.0;  ///< standard deviation that stands for "unknown", metres
  double unknown_rotation = 3.0;      ///< the same in radians

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

struct VisibilityOptions {
  double tolerance = 0.4;   ///< between a surface and the end of a beam that shows it, metres
  double nearest = 0.3;     ///< closer surfaces are parts of the robot, metres
  double farthest = 12.0;   ///< beyond, a small turn of the robot makes a beam miss, metres
  double min_facing = 0.3;  ///< least cosine between beam and normal: a beam that grazes a wall
                            ///< passes it within the tolerance

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

}  // namespace loopgrid
