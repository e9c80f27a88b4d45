#pragma once

#include <cstdint>
#include <cstdlib>

namespace loopgrid {

/// A place on the grid in whole 1/1024 of a cell: fine enough to lose nothing (0.05 mm in cells of
/// 5 cm), and integers make the walk exact.
struct GridPoint {
  static constexpr int kFractionBits = 10;
  static constexpr std::int64_t kOne = std::int64_t{1} << kFractionBits;

  std::int64_t x = 0;
  std::int64_t y = 0;

  /// The cell is half-open, [i, i + 1), so that each point is in exactly one.
  std::int64_t cell_x() const { return x >> kFractionBits; }
  std::int64_t cell_y() const { return y >> kFractionBits; }
};

/// Calls `visit(cell_x, cell_y)` once for each cell that the segment from `from` to `to` crosses,
/// in order, but not for the cell of `to`: that is where the beam ends. A cell is crossed if the
/// segment has `from` or a piece of positive length in it, so a corner met exactly is passed
/// diagonally. After Amanatides and Woo, "A fast voxel traversal algorithm for ray tracing",
/// Eurographics 1987, in integers. Coordinates may differ by up to 2^50.
template <typename Visit>
void WalkRay(GridPoint from, GridPoint to, Visit&& visit) {
  std::int64_t x = from.cell_x();
  std::int64_t y = from.cell_y();
  std::int64_t steps_x = std::abs(to.cell_x() - x);  // boundaries still to be crossed
  std::int64_t steps_y = std::abs(to.cell_y() - y);
  const std::int64_t sign_x = to.x < from.x ? -1 : 1;
  const std::int64_t sign_y = to.y < from.y ? -1 : 1;
  const std::int64_t length_x = std::abs(to.x - from.x);
  const std::int64_t length_y = std::abs(to.y - from.y);

  // From the start to the first boundary on the way, along each axis.
  const std::int64_t gap_x = sign_x > 0 ? ((x + 1) << GridPoint::kFractionBits) - from.x
                                        : from.x - (x << GridPoint::kFractionBits);
  const std::int64_t gap_y = sign_y > 0 ? ((y + 1) << GridPoint::kFractionBits) - from.y
                                        : from.y - (y << GridPoint::kFractionBits);

  // Which boundary comes first: the sign of gap_x / length_x - gap_y / length_y.
  std::int64_t order = gap_x * length_y - gap_y * length_x;
  const std::int64_t advance_x = length_y << GridPoint::kFractionBits;
  const std::int64_t advance_y = length_x << GridPoint::kFractionBits;
  while (steps_x > 0 && steps_y > 0) {
    visit(x, y);
    // Which way is close to random: arithmetic instead of branches, which would be mispredicted.
    const std::int64_t cross_x = order <= 0;
    const std::int64_t cross_y = order >= 0;
    x += sign_x & -cross_x;
    y += sign_y & -cross_y;
    order += (advance_x & -cross_x) - (advance_y & -cross_y);
    steps_x -= cross_x;
    steps_y -= cross_y;
  }
  for (; steps_x > 0; --steps_x, x += sign_x) visit(x, y);
  for (; steps_y > 0; --steps_y, y += sign_y) visit(x, y);
}

}  // namespace loopgrid
