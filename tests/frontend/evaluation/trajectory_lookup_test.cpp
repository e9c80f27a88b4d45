#include "frontend/evaluation/trajectory_lookup.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace loopgrid {
namespace {

TEST(TrajectoryLookup, NearestAgreesWithLookingAtEveryPose) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Trajectory trajectory;
    const std::size_t size = random() % 30;
    // Times on a grid: many repeat, and many queries lie exactly between two.
    for (std::size_t i = 0; i < size; ++i) {
      trajectory.push_back({0.5 * static_cast<double>(random() % 20), SE2()});
    }
    const TrajectoryLookup lookup(trajectory);
    for (int query = -8; query < 100; ++query) {
      const double time = 0.125 * query;
      const double tolerance = 0.125 * static_cast<double>(random() % 8);
      std::optional<std::size_t> expected;
      for (std::size_t i = 0; i < size; ++i) {
        const double distance = std::abs(trajectory[i].timestamp - time);
        const bool nearer =
            !expected || distance < std::abs(trajectory[*expected].timestamp - time);
        if (distance <= tolerance && nearer) expected = i;
      }
      EXPECT_EQ(lookup.Nearest(time, tolerance), expected) << time << " +- " << tolerance;
    }
  }
}

TEST(TrajectoryLookup, InterpolatesBetweenThePosesThatBracketTheTime) {
  // The clock ran backwards: in file order the bracket of 2.5 would be wrong.
  const Trajectory trajectory = {
      {1.0, SE2(1.0, 10.0, 0.0)}, {3.0, SE2(3.0, 30.0, 0.4)}, {2.0, SE2(2.0, 20.0, 0.2)}};
  const TrajectoryLookup lookup(trajectory);
  const auto pose = lookup.Interpolate(2.25);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->x(), 2.25, 1e-12);
  EXPECT_NEAR(pose->y(), 22.5, 1e-12);
  EXPECT_NEAR(pose->theta(), 0.25, 1e-12);
  EXPECT_EQ(lookup.Interpolate(3.0)->x(), 3.0);
  EXPECT_EQ(lookup.Interpolate(1.0)->x(), 1.0);
}

TEST(TrajectoryLookup, TurnsTheShortWayRound) {
  const Trajectory trajectory = {{0.0, SE2(0.0, 0.0, 3.0)}, {1.0, SE2(0.0, 0.0, -3.0)}};
  const TrajectoryLookup lookup(trajectory);
  EXPECT_NEAR(std::abs(lookup.Interpolate(0.5)->theta()), std::numbers::pi, 1e-12);
}

TEST(TrajectoryLookup, KnowsNothingOutsideItsTimeSpan) {
  const Trajectory trajectory = {{1.0, SE2()}, {2.0, SE2()}};
  const TrajectoryLookup lookup(trajectory);
  EXPECT_FALSE(lookup.Interpolate(0.999));
  EXPECT_FALSE(lookup.Interpolate(2.001));
  const Trajectory empty;
  EXPECT_FALSE(TrajectoryLookup(empty).Interpolate(1.0));
  EXPECT_FALSE(TrajectoryLookup(empty).Nearest(1.0, 1e9));
}

}  // namespace
}  // namespace loopgrid
