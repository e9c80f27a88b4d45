#pragma once

#include <cstdint>
#include <cstdlib>

namespace loopgrid {

/// A place on the grid, on a lattice of 1024 x 1024 points a cell (0.05 mm apart in cells of
/// 5 cm). The lattice lies half a step inside the cell: (x, y) stands for ((x + 1/2) / 1024,
/// (y + 1/2) / 1024) cells, so no point is ever on a boundary.
struct GridPoint {
  static constexpr int kFractionBits = 10;
  static constexpr std::int64_t kOne = std::int64_t{1} << kFractionBits;

  std::int64_t x = 0;
  std::int64_t y = 0;

  std::int64_t cell_x() const { return x >> kFractionBits; }
  std::int64_t cell_y() const { return y >> kFractionBits; }
};

/// Calls `visit(cell_x, cell_y)` once for each cell that the segment from `from` to `to` crosses,
/// in order, but not for the cell of `to`: that is where the beam ends. Exact: a cell that the
/// segment touches only at a corner is not crossed. After Amanatides and Woo, "A fast voxel
/// traversal algorithm for ray tracing", Eurographics 1987, in integers. Coordinates may differ by
/// 2^50.
template <typename Visit>
void WalkRay(GridPoint from, GridPoint to, Visit&& visit) {
  std::int64_t x = from.cell_x();
  std::int64_t y = from.cell_y();
  const std::int64_t sign_x = to.x < from.x ? -1 : 1;
  const std::int64_t sign_y = to.y < from.y ? -1 : 1;

  // In half steps of the lattice: from the start to the first boundary ahead on either axis, and
  // between two boundaries.
  constexpr std::int64_t kPitch = 2 * GridPoint::kOne;
  const std::int64_t inside_x = 2 * (from.x & (GridPoint::kOne - 1)) + 1;
  const std::int64_t inside_y = 2 * (from.y & (GridPoint::kOne - 1)) + 1;
  const std::int64_t gap_x = sign_x > 0 ? kPitch - inside_x : inside_x;
  const std::int64_t gap_y = sign_y > 0 ? kPitch - inside_y : inside_y;

  // `order` has the sign of gap_x / length_x - gap_y / length_y and so says which boundary comes
  // first. Neighbouring rays branch in nearly the same way, so these branches are predicted well.
  const std::int64_t length_x = std::abs(to.x - from.x);
  const std::int64_t length_y = std::abs(to.y - from.y);
  const std::int64_t advance_x = kPitch * length_y;
  const std::int64_t advance_y = kPitch * length_x;
  std::int64_t order = gap_x * length_y - gap_y * length_x;
  std::int64_t boundaries = std::abs(to.cell_x() - x) + std::abs(to.cell_y() - y);
  while (boundaries > 0) {
    visit(x, y);
    if (order < 0) {
      x += sign_x;
      order += advance_x;
      boundaries -= 1;
    } else if (order > 0) {
      y += sign_y;
      order -= advance_y;
      boundaries -= 1;
    } else {  // through the corner
      x += sign_x;
      y += sign_y;
      order += advance_x - advance_y;
      boundaries -= 2;
    }
  }
}

}  // namespace loopgrid
