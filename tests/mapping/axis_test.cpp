#include "mapping/axis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace loopgrid {
namespace {

using ::testing::ElementsAre;
using ::testing::IsSupersetOf;

std::vector<std::string> Labels(const Axis& axis, int count) {
  std::vector<std::string> labels;
  for (const AxisTick& tick : axis.Ticks(count)) {
    if (tick.label.empty()) continue;
    labels.push_back(tick.exponent.empty() ? tick.label : tick.label + "^" + tick.exponent);
  }
  return labels;
}

TEST(RoundDown, GivesOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(RoundDown(1.0), 1.0);
  EXPECT_DOUBLE_EQ(RoundDown(1.99), 1.0);
  EXPECT_DOUBLE_EQ(RoundDown(4.9), 2.0);
  EXPECT_DOUBLE_EQ(RoundDown(999.0), 500.0);
  EXPECT_DOUBLE_EQ(RoundDown(0.03), 0.02);
}

TEST(Axis, HasRoundLabelsWithinItsEnds) {
  EXPECT_THAT(Labels(Axis(0.0, 10.0, false), 10), ElementsAre("0", "2", "4", "6", "8", "10"));
  EXPECT_THAT(Labels(Axis(-0.3, 0.3, false), 7),
              ElementsAre("-0.3", "-0.2", "-0.1", "0", "0.1", "0.2", "0.3"));
  EXPECT_THAT(Labels(Axis(0.0, 100.0, false), 10), ElementsAre("0", "20", "40", "60", "80", "100"));
}

TEST(Axis, LabelsDecadesAndWhereThereAreFewAlsoBetweenThem) {
  EXPECT_THAT(Labels(Axis(700.0, 2e6, true), 10), ElementsAre("10^3", "10^4", "10^5", "10^6"));
  EXPECT_THAT(
      Labels(Axis(1e-25, 1e5, true), 10),
      ElementsAre("10^-24", "10^-20", "10^-16", "10^-12", "10^-8", "10^-4", "10^0", "10^4"));
  EXPECT_THAT(Labels(Axis(30.0, 900.0, true), 10), IsSupersetOf({"50", "100", "200", "500"}));
}

TEST(Axis, IsLinearOrLogarithmicBetweenItsEnds) {
  const Axis linear(10.0, 20.0, false);
  EXPECT_NEAR(linear.Position(15.0), 0.5, 1e-12);
  EXPECT_GT(linear.Position(10.0), 0.0);
  EXPECT_LT(linear.Position(20.0), 1.0);
  const Axis logarithmic(10.0, 1000.0, true);
  EXPECT_NEAR(logarithmic.Position(100.0), 0.5, 1e-12);
  EXPECT_EQ(logarithmic.Position(0.0), 0.0);
  EXPECT_EQ(logarithmic.Position(-5.0), 0.0);
  EXPECT_EQ(logarithmic.Position(1e-9), 0.0);
}

TEST(Axis, GivesASingleValueRoomOnBothSides) {
  for (double value : {0.0, 3.0, -7e5}) {
    const Axis axis(value, value, false);
    EXPECT_NEAR(axis.Position(value), 0.5, 1e-9) << value;
    EXPECT_GT(axis.Ticks(10).size(), 2u) << value;
  }
  EXPECT_NEAR(Axis(5.0, 5.0, true).Position(5.0), 0.5, 1e-9);
}

TEST(Axis, KeepsItsTicksWithinAnyRange) {
  for (double lowest : {1e-300, 1e-3, 1.0, 5.0, 1e250}) {
    for (double factor : {1.0, 1.001, 25.0, 1e6, 1e40}) {
      for (bool logarithmic : {false, true}) {
        const Axis axis(lowest, lowest * factor, logarithmic);
        const auto ticks = axis.Ticks(10);
        EXPECT_LE(ticks.size(), 100u) << lowest << " x " << factor;
        for (const AxisTick& tick : ticks) {
          EXPECT_GT(axis.Position(tick.value), -1e-6) << lowest << " x " << factor;
          EXPECT_LT(axis.Position(tick.value), 1.0 + 1e-6) << lowest << " x " << factor;
        }
      }
    }
  }
}

}  // namespace
}  // namespace loopgrid
