#include "frontend/matching/thinning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace loopgrid {
namespace {

using ThinnedPoints = std::vector<Eigen::Vector2f>;

TEST(ThinPoints, KeepsConsecutivePointsApartAndDropsNoneThatAreFar) {
  std::mt19937 random(3);
  std::normal_distribution<float> step(0.0F, 0.04F);
  ThinnedPoints points = {{1.0F, 2.0F}};
  for (int i = 0; i < 2000; ++i) {
    points.emplace_back(points.back() + Eigen::Vector2f(step(random), step(random)));
  }
  for (float spacing : {0.02F, 0.05F, 0.3F}) {
    const ThinnedPoints kept = ThinPoints(points, spacing);
    EXPECT_EQ(kept.front(), points.front());
    auto next = kept.begin();  // in order; each dropped point is close to the last one kept
    for (const Eigen::Vector2f& p : points) {
      if (next != kept.end() && p == *next) {
        const float gap = next == kept.begin() ? spacing : (*next - *(next - 1)).norm();
        EXPECT_GE(gap, 0.999F * spacing);
        ++next;
      } else {
        ASSERT_LT((p - *(next - 1)).norm(), spacing);
      }
    }
    EXPECT_EQ(next, kept.end());
  }
}

TEST(ThinPoints, KeepsAllWithoutSpacingAndNoneOfNone) {
  const ThinnedPoints points = {{0.0F, 0.0F}, {0.0F, 0.0F}, {1.0F, 0.0F}};
  EXPECT_EQ(ThinPoints(points, 0.0F), points);
  EXPECT_EQ(ThinPoints(points, 0.1F).size(), 2U);
  EXPECT_TRUE(ThinPoints({}, 0.1F).empty());
}

TEST(AngleStepFor, MovesFourFifthsOfThePointsByNoMoreThanACell) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> range(3.0F, 12.0F);
    ThinnedPoints points;
    for (int i = 0; i < 200; ++i) {
      const float angle = 0.03F * static_cast<float>(i);
      points.emplace_back(range(random) * Eigen::Vector2f(std::cos(angle), std::sin(angle)));
    }
    const double step = AngleStepFor(points, 0.05);
    const auto moved = std::count_if(points.begin(), points.end(), [&](const auto& p) {
      return static_cast<double>(p.norm()) * step <= 0.05 + 1e-9;
    });
    EXPECT_GE(moved, 160);
    EXPECT_LE(moved, 162);
  }
}

TEST(AngleStepFor, StaysWithinItsBounds) {
  EXPECT_EQ(AngleStepFor({}, 0.05), 0.02);
  EXPECT_EQ(AngleStepFor(ThinnedPoints(10, {0.0F, 0.0F}), 0.05), 0.02);
  EXPECT_EQ(AngleStepFor(ThinnedPoints(1, {0.01F, 0.0F}), 0.05), 0.02);
  EXPECT_EQ(AngleStepFor(ThinnedPoints(10, {100.0F, 0.0F}), 0.05), 0.004);
}

}  // namespace
}  // namespace loopgrid
