#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "backend/geometry/se2.h"
#include "frontend/matching/likelihood_table.h"
#include "frontend/matching/matching_options.h"

namespace loopgrid {

/// The odometry as a prior: a candidate n sigmas from the window's centre loses `weight * n^2 / 2`
/// of its score. A weight of 0 ignores the prior.
struct SearchPrior {
  double sigma_translation = 0.1;  ///< metres
  double sigma_rotation = 0.1;     ///< radians
  double weight = 0.0;             ///< in units of the score (0..1)
};

/// A candidate of the search: cells and angular steps from the window's centre.
struct SearchOffset {
  int x = 0;
  int y = 0;
  int angle = 0;

  friend bool operator==(const SearchOffset&, const SearchOffset&) = default;
};

struct SearchResult {
  bool found = false;   ///< some candidate reached the least score
  SearchOffset offset;  ///< the best candidate; of equal ones the first by (angle, y, x)
  SE2 T_map_robot;
  double score = 0.0;  ///< mean likelihood of the hits minus the prior's penalty, at most 1
};

/// Exhaustive search over (x, y, rotation) after Olson, "Real-time correlative scan matching" (ICRA
/// 2009): all candidates on a lattice of one table cell and one angular step. Branch and bound over
/// the table's pyramid finds the same candidate as trying all of them.
class CorrelativeSearch {
 public:
  /// `points` in the robot frame; the window is centred on `T_map_robot`. `angle_step` in radians.
  /// The table needs a margin of at least MarginFor(window).
  CorrelativeSearch(const LikelihoodTable& table, std::span<const Eigen::Vector2f> points,
                    const SE2& T_map_robot, const SearchWindow& window, double angle_step,
                    const SearchPrior& prior = {});

  /// The best candidate with a score above `min_score`.
  SearchResult Best(double min_score) const;

  /// The best candidate away from `peak`: more than `cells` from it in x or y, or more than `steps`
  /// in angle. Its score shows whether the peak is unique.
  SearchResult BestAwayFrom(const SearchOffset& peak, int cells, int steps, double min_score) const;

  /// Score of one candidate, by plain summation.
  double Score(const SearchOffset& offset) const;

  SE2 PoseAt(const SearchOffset& offset) const;

  int cells_x() const { return cells_x_; }
  int cells_y() const { return cells_y_; }
  int angle_steps() const { return angle_steps_; }

  /// Cells that a table must reach beyond the reference points' box (kernel included) for `window`.
  static int MarginFor(const SearchWindow& window, float resolution, int levels);

 private:
  struct Block {
    SearchOffset corner;  // smallest x and y
    int level = 0;
    int bound = 0;
  };
  struct Exclusion {
    SearchOffset peak;
    int cells = -1;
    int steps = -1;
  };
  struct Incumbent {
    int score = 0;
    SearchOffset offset;
    bool found = false;
  };

  SearchResult Run(const Exclusion& exclusion, double min_score) const;
  void Explore(const Block& block, const Exclusion& exclusion, Incumbent* best) const;
  int Bound(const SearchOffset& corner, int level) const;
  int Penalty(const SearchOffset& corner, int level) const;
  bool CanBeat(const Block& block, const Incumbent& best) const;

  const LikelihoodTable& table_;
  SE2 center_;
  double angle_step_;
  int cells_x_;
  int cells_y_;
  int angle_steps_;
  int full_score_;                       // score of a perfect match, in table units
  std::vector<std::vector<int>> cells_;  // per angle: table index of each point
  std::vector<int> penalty_cells_;       // by distance from the centre
  std::vector<int> penalty_angle_;
};

}  // namespace loopgrid
