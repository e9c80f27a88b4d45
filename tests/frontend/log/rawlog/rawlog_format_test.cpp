#include "frontend/log/rawlog/rawlog_format.h"

#include <gtest/gtest.h>

#include <string>

namespace loopgrid {
namespace {

TEST(RawlogFormat, IsKnownByBothHeadersOfAnObject) {
  EXPECT_TRUE(
      LooksLikeRawlog("\x8d"
                      "CSensoryFrame"));
  EXPECT_TRUE(LooksLikeRawlog("\x98mrpt::obs::CSensoryFrame\x01"));
  EXPECT_TRUE(LooksLikeRawlog(std::string("\x0d\0\0\0CSensoryFrame\0\0\0\0", 21)));
  EXPECT_FALSE(LooksLikeRawlog("FLASER 180 1.0 1.0"));
  EXPECT_FALSE(LooksLikeRawlog("# CARMEN Logfile"));
  EXPECT_FALSE(LooksLikeRawlog("\x8d"));
  EXPECT_FALSE(LooksLikeRawlog(""));
  EXPECT_FALSE(LooksLikeRawlog(std::string(100, '\0')));
}

TEST(RawlogFormat, NamesOfClassesBeginAsMrptsDo) {
  EXPECT_TRUE(IsMrptClassName("mrpt::obs::CObservation2DRangeScan"));
  EXPECT_TRUE(IsMrptClassName("CPose3D"));
  EXPECT_TRUE(IsMrptClassName("nullptr"));
  EXPECT_FALSE(IsMrptClassName("std::string"));
  EXPECT_FALSE(IsMrptClassName("CPose3D\n"));
  EXPECT_FALSE(IsMrptClassName("CPo"));
  EXPECT_FALSE(IsMrptClassName(""));
}

}  // namespace
}  // namespace loopgrid
