#include "mapping/ray_walk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace loopgrid {
namespace {

using CellNumber = std::pair<std::int64_t, std::int64_t>;
using testing::ElementsAre;
using testing::IsEmpty;

std::vector<CellNumber> Walk(GridPoint from, GridPoint to) {
  std::vector<CellNumber> cells;
  WalkRay(from, to, [&](std::int64_t x, std::int64_t y) { cells.emplace_back(x, y); });
  return cells;
}

/// The lattice point nearest to the middle of the cell.
GridPoint Middle(std::int64_t cell_x, std::int64_t cell_y) {
  return {cell_x * GridPoint::kOne + GridPoint::kOne / 2,
          cell_y * GridPoint::kOne + GridPoint::kOne / 2};
}

// A fraction with a positive denominator; comparisons are exact.
struct Fraction {
  __int128 numerator;
  __int128 denominator;
  friend bool operator<(const Fraction& a, const Fraction& b) {
    return a.numerator * b.denominator < b.numerator * a.denominator;
  }
};

// Liang-Barsky in rational numbers: does a piece of the segment that is longer than a point lie
// inside the cell? `low` and `high` bound the part t in [0, 1] that is inside the slabs so far.
bool ClipToSlab(std::int64_t start, std::int64_t delta, std::int64_t cell, Fraction* low,
                Fraction* high) {
  // In half steps of the lattice: points are odd, boundaries are even.
  const __int128 first = 2 * GridPoint::kOne * cell - (2 * start + 1);
  const __int128 last = first + 2 * GridPoint::kOne;
  if (delta == 0) return first < 0 && last > 0;
  const __int128 run = 2 * static_cast<__int128>(delta);
  Fraction enter = run > 0 ? Fraction{first, run} : Fraction{-last, -run};
  Fraction leave = run > 0 ? Fraction{last, run} : Fraction{-first, -run};
  *low = std::max(*low, enter);
  *high = std::min(*high, leave);
  return *low < *high;
}

bool Crosses(GridPoint from, GridPoint to, CellNumber cell) {
  Fraction low{0, 1};
  Fraction high{1, 1};
  return ClipToSlab(from.x, to.x - from.x, cell.first, &low, &high) &&
         ClipToSlab(from.y, to.y - from.y, cell.second, &low, &high);
}

// All cells of the bounding box that the segment crosses, without the one in which it ends.
std::set<CellNumber> BruteForce(GridPoint from, GridPoint to) {
  std::set<CellNumber> cells;
  const auto [min_x, max_x] = std::minmax({from.cell_x(), to.cell_x()});
  const auto [min_y, max_y] = std::minmax({from.cell_y(), to.cell_y()});
  for (std::int64_t y = min_y; y <= max_y; ++y) {
    for (std::int64_t x = min_x; x <= max_x; ++x) {
      if (Crosses(from, to, {x, y})) cells.insert({x, y});
    }
  }
  cells.erase({to.cell_x(), to.cell_y()});
  return cells;
}

void ExpectAgreesWithBruteForce(GridPoint from, GridPoint to) {
  const std::vector<CellNumber> walked = Walk(from, to);
  const std::set<CellNumber> distinct(walked.begin(), walked.end());
  ASSERT_EQ(distinct.size(), walked.size()) << "a cell was visited twice";
  ASSERT_EQ(distinct, BruteForce(from, to))
      << "from " << from.x << ", " << from.y << " to " << to.x << ", " << to.y;
}

TEST(WalkRay, AlongAnAxisVisitsEachCellButTheLast) {
  EXPECT_THAT(Walk(Middle(0, 5), Middle(3, 5)),
              ElementsAre(CellNumber{0, 5}, CellNumber{1, 5}, CellNumber{2, 5}));
  EXPECT_THAT(Walk(Middle(1, 2), Middle(1, -1)),
              ElementsAre(CellNumber{1, 2}, CellNumber{1, 1}, CellNumber{1, 0}));
}

TEST(WalkRay, WithinOneCellVisitsNothing) {
  EXPECT_THAT(Walk(Middle(4, -4), Middle(4, -4)), IsEmpty());
  EXPECT_THAT(Walk({0, 0}, {GridPoint::kOne - 1, GridPoint::kOne - 1}), IsEmpty());
}

TEST(WalkRay, PassesCornersDiagonally) {
  EXPECT_THAT(Walk({0, 0}, {2048, 2048}), ElementsAre(CellNumber{0, 0}, CellNumber{1, 1}));
  EXPECT_THAT(Walk({0, 2047}, {2047, 0}), ElementsAre(CellNumber{0, 1}));
  EXPECT_THAT(Walk({-1, -1}, {0, 0}), ElementsAre(CellNumber{-1, -1}));
}

TEST(WalkRay, AgreesWithRationalClippingOnRandomRays) {
  std::mt19937 random(3);
  for (int i = 0; i < 5000; ++i) {
    // Short and long rays, in all quadrants, across the origin.
    const std::int64_t reach = GridPoint::kOne << (random() % 6);
    std::uniform_int_distribution<std::int64_t> place(-reach, reach);
    ASSERT_NO_FATAL_FAILURE(
        ExpectAgreesWithBruteForce({place(random), place(random)}, {place(random), place(random)}))
        << "ray " << i;
  }
}

TEST(WalkRay, AgreesWithRationalClippingWhereRaysMeetCornersAndAxes) {
  std::mt19937 random(4);
  std::uniform_int_distribution<std::int64_t> cell(-9, 9);
  // Multiples of a fraction of a cell make ties frequent; the offsets are beside boundaries.
  const std::int64_t offsets[] = {0, 1, 255, 256, 511, 512, 1022, 1023};
  for (int i = 0; i < 5000; ++i) {
    const std::int64_t at = offsets[random() % 8];
    const GridPoint from{cell(random) * GridPoint::kOne + at, cell(random) * GridPoint::kOne + at};
    const GridPoint to{from.x + cell(random) * 512, from.y + cell(random) * 512};
    ASSERT_NO_FATAL_FAILURE(ExpectAgreesWithBruteForce(from, to)) << "ray " << i;
    ASSERT_NO_FATAL_FAILURE(ExpectAgreesWithBruteForce({from.x, from.y}, {from.x, to.y}));
    ASSERT_NO_FATAL_FAILURE(ExpectAgreesWithBruteForce({from.x, from.y}, {to.x, from.y}));
  }
}

TEST(WalkRay, BackwardsVisitsTheSameCells) {
  std::mt19937 random(5);
  std::uniform_int_distribution<std::int64_t> place(-20000, 20000);
  for (int i = 0; i < 1000; ++i) {
    const GridPoint a{place(random), place(random)};
    const GridPoint b{place(random), place(random)};
    std::vector<CellNumber> there = Walk(a, b);
    there.emplace_back(b.cell_x(), b.cell_y());
    std::vector<CellNumber> back = Walk(b, a);
    back.emplace_back(a.cell_x(), a.cell_y());
    std::reverse(back.begin(), back.end());
    ASSERT_EQ(there, back) << "ray " << i;
  }
}

TEST(WalkRay, IsExactFarFromTheOrigin) {
  const std::int64_t far = (std::int64_t{1} << 30) * GridPoint::kOne;
  const GridPoint from{far + 17, -far + 900};
  ExpectAgreesWithBruteForce(from, {from.x + 30000, from.y - 12345});
}

TEST(WalkRay, EndsWhereItShouldAfterAMillionCells) {
  const GridPoint from{5, 7};
  const GridPoint to{GridPoint::kOne * 1'000'003 + 1, GridPoint::kOne * -999'999 + 2};
  CellNumber last{0, 0};
  std::int64_t count = 0;
  WalkRay(from, to, [&](std::int64_t x, std::int64_t y) {
    last = {x, y};
    ++count;
  });
  EXPECT_LE(std::abs(last.first - to.cell_x()) + std::abs(last.second - to.cell_y()), 2);
  EXPECT_NEAR(static_cast<double>(count), 2.0e6, 10.0);
}

}  // namespace
}  // namespace loopgrid
