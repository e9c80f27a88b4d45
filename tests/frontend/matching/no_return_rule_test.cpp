#include "frontend/matching/no_return_rule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/office_world.h"
#include "tests/support/rooms.h"

namespace loopgrid {
namespace {

using test_support::DistinctiveRoom;
using test_support::PortableRandom;
using test_support::SimulatedLaser;
using test_support::SimulateScan;
using test_support::World;

constexpr double kPi = std::numbers::pi;

// A scan of the room's walls. `missing` of its beams read one of `values` instead.
LaserScan RoomScan(const std::vector<float>& values, int missing, PortableRandom* random,
                   int beams = 180) {
  SimulatedLaser laser;
  laser.beams = beams;
  laser.angle_step = kPi / beams;
  const SE2 pose{random->Uniform(-2.0, 0.0), random->Uniform(-2.0, 0.0), random->Uniform(-3, 3)};
  LaserScan scan = SimulateScan(DistinctiveRoom(), pose, laser, random);
  const auto first = static_cast<std::size_t>(random->Uniform(0.0, beams - missing));
  for (std::size_t i = first; i < first + static_cast<std::size_t>(missing); ++i) {
    scan.ranges[i] = values[i % values.size()];
  }
  return scan;
}

float Farthest(const PointScan& points) {
  float farthest = 0.0F;
  for (const Eigen::Vector2f& hit : points.hits) farthest = std::max(farthest, hit.norm());
  return farthest;
}

struct NoReturn {
  const char* name;
  std::vector<float> values;
};

class NoReturnValue : public ::testing::TestWithParam<NoReturn> {};

TEST_P(NoReturnValue, NeverBecomesAHitAndTheRoomsWallsAllDo) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    PortableRandom random(seed);
    NoReturnRule sensor;
    for (int k = 0; k < 12; ++k) {
      // The first scan already: 20 of 180.
      const int missing = k == 0 ? 20 : static_cast<int>(random.Uniform(0.0, 100.0));
      const LaserScan scan = RoomScan(GetParam().values, missing, &random);
      const PointScan points = sensor.Interpret(scan);
      const float nearest_no_return =
          *std::min_element(GetParam().values.begin(), GetParam().values.end());
      int walls = 0;
      for (float range : scan.ranges) walls += range < 0.9F * nearest_no_return ? 1 : 0;
      EXPECT_LT(Farthest(points), 0.98F * nearest_no_return);
      EXPECT_EQ(static_cast<int>(points.no_returns.size()), missing);
      EXPECT_GE(static_cast<int>(points.size()), walls);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Of, NoReturnValue,
    ::testing::Values(NoReturn{"Lms200", {81.83F}}, NoReturn{"Lms200InHalfDegrees", {81.91F}},
                      NoReturn{"Aces", {50.0F}}, NoReturn{"Killian", {51.05F, 51.15F, 51.25F}},
                      NoReturn{"AcrossTwoBins", {50.99F, 51.0F, 51.01F}},
                      NoReturn{"Fifteen", {32.77F}}, NoReturn{"Millimetres", {32.767F}},
                      NoReturn{"Clamped", {kFarthestReading}}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(NoReturnRule, LearnsTheEightMetresOfAnLms200InMillimetreMode) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    PortableRandom random(seed);
    NoReturnRule sensor;
    for (int k = 0; k < 10; ++k) {
      // In a room of 5 m; beams that go farther do not return.
      LaserScan scan = RoomScan({8.191F}, 40, &random);
      for (float& range : scan.ranges) range = range > 5.5F ? 8.191F : range;
      EXPECT_LT(Farthest(sensor.Interpret(scan)), 6.0F);
    }
    EXPECT_GT(sensor.usable_range(), 6.0);
    EXPECT_LT(sensor.usable_range(), 8.191);
  }
}

TEST(NoReturnRule, TakesTheLogsMaximumRangeWhereItIsLower) {
  PortableRandom random(3);
  LaserScan scan = RoomScan({5.5F}, 3, &random);  // too few to be learned
  scan.max_range = 5.5;
  NoReturnRule sensor;
  const PointScan points = sensor.Interpret(scan);
  EXPECT_EQ(sensor.usable_range(), 5.5);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LT((points.hits[i] - points.T_robot_laser.translation().cast<float>()).norm(), 5.5F);
  }
  EXPECT_EQ(points.size() + points.no_returns.size(), 180U);
}

TEST(NoReturnRule, IsNotMisledByALogThatStatesTooLargeARange) {
  PortableRandom random(4);
  LaserScan scan = RoomScan({32.77F}, 30, &random);
  scan.max_range = 50.0;  // many logs state this value, for all lasers
  EXPECT_LT(Farthest(NoReturnRule().Interpret(scan)), 12.0F);
}

TEST(NoReturnRule, KeepsTheWallsOfRoomsOfAnySizeOrShape) {
  // All readings of the first scan are nearly equal. They must not be taken for no-returns.
  for (double half = 0.4; half < 9.0; half += 0.1) {
    SCOPED_TRACE(half);
    World square;
    square.AddBox({0.0, 0.0}, {2.0 * half, 2.0 * half});
    for (double x : {0.0, 0.3 * half}) {
      PortableRandom random(7);
      const LaserScan scan = SimulateScan(square, SE2(x, 0.0, 0.0), {}, &random);
      NoReturnRule sensor;
      EXPECT_EQ(sensor.Interpret(scan).size(), 180U);
    }
  }
}

TEST(NoReturnRule, KeepsTheEndOfALongCorridorOnceTheRobotHasMovedAMetre) {
  World corridor;
  corridor.AddBox({15.0, 0.0}, {36.0, 2.4});
  PortableRandom random(8);
  SimulatedLaser laser;
  laser.usable_range = 79.0;
  NoReturnRule sensor;
  for (int k = 0; k < 10; ++k) {
    const LaserScan scan = SimulateScan(corridor, SE2(0.2 * k, 0.0, 0.01 * k), laser, &random);
    // From one place alone, the end of the corridor makes a heap like that of a no-return value.
    const PointScan points = sensor.Interpret(scan);
    if (k >= 1 && k <= 3) {
      EXPECT_LT(points.size(), 180U);
    } else if (k >= 5) {
      EXPECT_EQ(points.size(), 180U);
    }
  }
  EXPECT_EQ(sensor.usable_range(), 40.0);
}

TEST(NoReturnRule, SaysTheSameWhateverComesLater) {
  const test_support::SimulatedRun run =
      test_support::Simulate(test_support::OfficeWorld(),
                             std::vector<Eigen::Vector2d>{{7.0, 7.0}, {9.0, 7.0}, {9.0, 3.5}});
  std::vector<std::size_t> hits;
  std::vector<double> ranges;
  NoReturnRule whole;
  for (const Observation& observation : run.observations) {
    hits.push_back(whole.Interpret(observation.scan).size());
    ranges.push_back(whole.usable_range());
  }
  for (std::size_t end : {std::size_t{1}, run.observations.size() / 2}) {
    NoReturnRule prefix;
    PortableRandom random(9);
    for (std::size_t i = 0; i < end; ++i) {
      EXPECT_EQ(prefix.Interpret(run.observations[i].scan).size(), hits[i]);
      EXPECT_EQ(prefix.usable_range(), ranges[i]);
    }
    prefix.Interpret(RoomScan({8.191F}, 170, &random));
  }
}

TEST(NoReturnRule, TakesScansOfAnotherNumberOfBeamsInBetween) {
  PortableRandom random(10);
  NoReturnRule sensor;
  for (int beams : {180, 361, 1, 90, 1081, 180}) {
    const LaserScan scan = RoomScan({81.83F}, beams / 4, &random, beams);
    const PointScan points = sensor.Interpret(scan);
    EXPECT_EQ(static_cast<int>(points.no_returns.size()), beams / 4);
    EXPECT_EQ(static_cast<int>(points.size()), beams - beams / 4);
    EXPECT_EQ(points.normals.size(), points.size());
  }
}

TEST(NoReturnRule, GoesByItsOptions) {
  PortableRandom random(12);
  const LaserScan scan = RoomScan({81.83F}, 20, &random);
  const NoReturnOptions options{.min_range = 1.5, .max_range = 3.0};
  NoReturnRule sensor(options);
  EXPECT_EQ(sensor.usable_range(), 3.0);
  const PointScan points = sensor.Interpret(scan);
  const auto between = [&](float low, float high) {
    return std::count_if(scan.ranges.begin(), scan.ranges.end(),
                         [&](float range) { return range >= low && range < high; });
  };
  EXPECT_EQ(std::ssize(points.hits), between(1.5F, 3.0F));
  EXPECT_EQ(std::ssize(points.no_returns), between(3.0F, 1e5F));
  EXPECT_GT(std::ssize(points.hits), 0);
}

TEST(NoReturnRule, TakesErrorValuesForNothing) {
  PortableRandom random(11);
  const PointScan points = NoReturnRule().Interpret(RoomScan({0.0F, 0.01F, 0.02F}, 60, &random));
  EXPECT_EQ(points.size(), 120U);
  EXPECT_TRUE(points.no_returns.empty());
}

TEST(NoReturnRule, BearsScansWithoutAnyReturn) {
  LaserScan scan;
  scan.angle_step = 0.01;
  for (float value : {0.0F, 81.83F, kFarthestReading}) {
    scan.ranges.assign(181, value);
    NoReturnRule sensor;
    for (int k = 0; k < 3; ++k) EXPECT_EQ(sensor.Interpret(scan).size(), 0U) << value;
  }
}

}  // namespace
}  // namespace loopgrid
