#include "frontend/matching/likelihood_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace loopgrid {
namespace {

using TablePoints = std::vector<Eigen::Vector2f>;

TablePoints RandomPoints(int count, float reach, std::mt19937* random) {
  std::uniform_real_distribution<float> coordinate(-reach, reach);
  TablePoints points;
  for (int i = 0; i < count; ++i) points.emplace_back(coordinate(*random), coordinate(*random));
  return points;
}

int ValueIn(const LikelihoodTable& table, int level, int x, int y) {
  return table.level(level)[y * table.width() + x];
}

// The largest of the kernels of all points, by the distance of their cells.
int NaiveValue(const LikelihoodTable& table, const TablePoints& points, int x, int y) {
  const auto resolution = static_cast<double>(table.resolution());
  const auto sigma = static_cast<double>(table.sigma());
  const int reach = static_cast<int>(std::ceil(3.0F * table.sigma() / table.resolution()));
  double largest = 0.0;
  for (const Eigen::Vector2f& p : points) {
    const Eigen::Vector2i cell = table.CellOf(p);
    const Eigen::Vector2i offset = cell - Eigen::Vector2i(x, y);
    const bool left_out = cell.minCoeff() < reach || cell.x() + reach >= table.width() ||
                          cell.y() + reach >= table.height();
    if (left_out || offset.cwiseAbs().maxCoeff() > reach) continue;
    const double squared = offset.cast<double>().squaredNorm() * resolution * resolution;
    largest = std::max(largest, 255.0 * std::exp(-0.5 * squared / (sigma * sigma)));
  }
  return static_cast<int>(std::lround(largest));
}

TEST(LikelihoodTable, HoldsInEachCellTheLargestOfAllKernels) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const float resolution = seed % 2 == 0 ? 0.05F : 0.1F;
    const float sigma = 0.03F * static_cast<float>(seed % 4 + 1);
    // The points reach beyond the table: some lie near its edge, some outside.
    const TablePoints points = RandomPoints(static_cast<int>(seed) * 3, 2.5F, &random);
    const LikelihoodTable table(points, {-1.0F, -1.5F}, {1.7F, 1.0F}, static_cast<int>(seed % 5),
                                resolution, sigma, 1);
    for (int y = 0; y < table.height(); ++y) {
      for (int x = 0; x < table.width(); ++x) {
        ASSERT_NEAR(ValueIn(table, 0, x, y), NaiveValue(table, points, x, y), 1) << x << ' ' << y;
        ASSERT_EQ(table.At({x, y}), ValueIn(table, 0, x, y));
      }
    }
  }
}

TEST(LikelihoodTable, LevelsHoldTheMaximaOfTheCellsThatBeginThere) {
  for (unsigned seed = 20; seed < 26; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    // Some tables are narrower than the cells of their upper levels.
    const float height = seed % 2 == 0 ? 0.1F : 2.0F;
    const LikelihoodTable table(RandomPoints(15, 1.5F, &random), {-1.0F, 0.0F}, {1.3F, height}, 4,
                                0.1F, 0.1F, 6);
    ASSERT_EQ(table.levels(), 6);
    for (int level = 1; level < 6; ++level) {
      const int side = 1 << level;
      for (int y = 0; y < table.height(); ++y) {
        for (int x = 0; x < table.width(); ++x) {
          int largest = 0;
          for (int v = y; v < std::min(y + side, table.height()); ++v) {
            for (int u = x; u < std::min(x + side, table.width()); ++u) {
              largest = std::max(largest, ValueIn(table, 0, u, v));
            }
          }
          ASSERT_EQ(ValueIn(table, level, x, y), largest) << level << ": " << x << ' ' << y;
        }
      }
    }
  }
}

TEST(LikelihoodTable, CoversTheBoxAndItsMargin) {
  const LikelihoodTable table({}, {1.0F, -2.0F}, {3.0F, -1.0F}, 7, 0.1F, 0.1F, 2);
  EXPECT_EQ(table.CellOf({1.001F, -1.999F}), Eigen::Vector2i(7, 7));
  const Eigen::Vector2i last = table.CellOf({2.999F, -1.001F});
  EXPECT_GE(table.width(), last.x() + 1 + 7);
  EXPECT_GE(table.height(), last.y() + 1 + 7);
  EXPECT_EQ(table.CellOf({0.99F, -2.01F}), Eigen::Vector2i(6, 6));
  EXPECT_EQ(table.CellOf({-9.01F, 8.99F}).x(), -94);  // rounds down, not towards zero
}

TEST(LikelihoodTable, IsZeroOutside) {
  const TablePoints points = {{0.05F, 0.05F}};
  const LikelihoodTable table(points, {0.0F, 0.0F}, {0.1F, 0.1F}, 4, 0.1F, 0.1F, 1);
  EXPECT_EQ(table.At(table.CellOf(points[0])), 255);
  EXPECT_EQ(table.At({-1, 4}), 0);
  EXPECT_EQ(table.At({4, -1}), 0);
  EXPECT_EQ(table.At({table.width(), 4}), 0);
  EXPECT_EQ(table.At({4, table.height()}), 0);
}

}  // namespace
}  // namespace loopgrid
