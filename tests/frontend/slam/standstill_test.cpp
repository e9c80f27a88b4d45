#include "frontend/slam/standstill.h"

#include <gtest/gtest.h>

namespace loopgrid {
namespace {

TEST(Standstill, HasEnoughAfterTheAskedForNumberOfScans) {
  Standstill standstill({.distance = 0.1, .angle = 0.2, .max_scans = 3});
  for (int scan = 1; scan <= 6; ++scan) {
    EXPECT_EQ(standstill.HasEnough(SE2(5.0, 5.0, 1.0)), scan > 3) << scan;
  }
}

TEST(Standstill, CountsAgainAfterAMotionOrATurn) {
  for (const SE2& motion : {SE2(0.11, 0.0, 0.0), SE2(0.0, 0.0, -0.21)}) {
    Standstill standstill({.distance = 0.1, .angle = 0.2, .max_scans = 2});
    const SE2 start(1.0, -2.0, 0.5);
    for (int scan = 0; scan < 4; ++scan) standstill.HasEnough(start);
    EXPECT_TRUE(standstill.HasEnough(start * SE2(0.09, 0.0, 0.19)));  // the same spot still
    EXPECT_FALSE(standstill.HasEnough(start * motion));
    EXPECT_FALSE(standstill.HasEnough(start * motion));
    EXPECT_TRUE(standstill.HasEnough(start * motion));
  }
}

TEST(Standstill, SlowMotionIsNoStandstill) {
  Standstill standstill({.distance = 0.1, .angle = 0.2, .max_scans = 5});
  for (int scan = 0; scan < 100; ++scan) {
    EXPECT_FALSE(standstill.HasEnough(SE2(3.0 + 0.03 * scan, 0.0, 0.0))) << scan;
  }
}

}  // namespace
}  // namespace loopgrid
