#include "frontend/log/carmen/carmen_line.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace loopgrid {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kFlaserLine =
    "FLASER 3 1.07 81.83 0 1.75 -2 0.1 1.5 -2.25 0.2 976052857.5 nohost 0.75";
const std::string kRobotLaserLine =
    "ROBOTLASER1 0 -1.5 3 0.5 50 0.01 1 4 1 2 3 4 2 77 88 0.25 0.5 0.75 1 2 3 0.1 0.2 0.3 0.4 0.5 "
    "101.5 nohost 1";
const std::string kRawLaserLine = "RAWLASER2 0 -1.5 3 1.5 50 0.01 0 3 1 2 3 1 5 102.5 nohost 2";

TEST(TagOf, KnowsTheMessagesThatMatter) {
  EXPECT_EQ(TagOf("FLASER 1 2"), CarmenTag::kFlaser);
  EXPECT_EQ(TagOf("RLASER"), CarmenTag::kRlaser);
  EXPECT_EQ(TagOf("ROBOTLASER1\t0"), CarmenTag::kRobotLaser1);
  EXPECT_EQ(TagOf(" ROBOTLASER2 0"), CarmenTag::kRobotLaser2);
  EXPECT_EQ(TagOf("RAWLASER1 0"), CarmenTag::kRawLaser1);
  EXPECT_EQ(TagOf("RAWLASER4 0"), CarmenTag::kRawLaser4);
  EXPECT_EQ(TagOf("ODOM 0"), CarmenTag::kOdom);
  EXPECT_EQ(TagOf("PARAM x"), CarmenTag::kParam);
}

TEST(TagOf, PassesOverEverythingElse) {
  for (const char* line : {"", "  ", "# FLASER 1", "#FLASER", "FLASER2 1", "flaser 1", "SYNC a 0",
                           "NEFF 1", "TRUEPOS 0 0 0", "MARKER x", "RAWLASER5 0", "\x80\xff"}) {
    EXPECT_EQ(TagOf(line), CarmenTag::kOther) << line;
    EXPECT_FALSE(IsLaser(TagOf(line)));
  }
}

TEST(ParseLaserLine, ReadsFlaser) {
  CarmenLaserMessage message;
  ASSERT_EQ(ParseLaserLine(kFlaserLine, &message), "");
  EXPECT_EQ(message.tag, CarmenTag::kFlaser);
  EXPECT_THAT(message.ranges, ElementsAre(1.07F, 81.83F, 0.0F));
  EXPECT_TRUE(message.has_poses);
  EXPECT_EQ(message.T_odom_laser.coordinates(), Eigen::Vector3d(1.75, -2.0, 0.1));
  EXPECT_EQ(message.T_odom_robot.coordinates(), Eigen::Vector3d(1.5, -2.25, 0.2));
  EXPECT_EQ(message.timestamp, 976052857.5);
  EXPECT_FALSE(message.has_angles);
  EXPECT_EQ(message.max_range, 0.0);
}

TEST(ParseLaserLine, TellsWhereTheLasersPoseStands) {
  for (const std::string& line : {kFlaserLine, kRobotLaserLine}) {
    CarmenLaserMessage message;
    ASSERT_EQ(ParseLaserLine(line, &message), "");
    const std::string text =
        line.substr(message.laser_pose_begin, message.laser_pose_end - message.laser_pose_begin);
    EXPECT_EQ(text, line == kFlaserLine ? "1.75 -2 0.1" : "0.25 0.5 0.75");
  }
}

TEST(ParseLaserLine, ReadsRobotLaser) {
  CarmenLaserMessage message;
  ASSERT_EQ(ParseLaserLine(kRobotLaserLine, &message), "");
  EXPECT_EQ(message.tag, CarmenTag::kRobotLaser1);
  EXPECT_TRUE(message.has_angles);
  EXPECT_EQ(message.start_angle, -1.5);
  EXPECT_EQ(message.field_of_view, 3.0);
  EXPECT_EQ(message.angular_resolution, 0.5);
  EXPECT_EQ(message.max_range, 50.0);
  EXPECT_THAT(message.ranges, ElementsAre(1.0F, 2.0F, 3.0F, 4.0F));
  EXPECT_EQ(message.T_odom_laser.coordinates(), Eigen::Vector3d(0.25, 0.5, 0.75));
  EXPECT_EQ(message.T_odom_robot.coordinates(), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(message.timestamp, 101.5);
}

TEST(ParseLaserLine, ReadsRawLaserWithoutPoses) {
  CarmenLaserMessage message;
  ASSERT_EQ(ParseLaserLine(kFlaserLine, &message),
            "");  // nothing of it may be left in the next message
  ASSERT_EQ(ParseLaserLine(kRawLaserLine, &message), "");
  EXPECT_EQ(message.tag, CarmenTag::kRawLaser2);
  EXPECT_FALSE(message.has_poses);
  EXPECT_EQ(message.angular_resolution, 1.5);
  EXPECT_THAT(message.ranges, ElementsAre(1.0F, 2.0F, 3.0F));
  EXPECT_EQ(message.timestamp, 102.5);
}

TEST(ParseLaserLine, TakesTabsAndManyBlanks) {
  CarmenLaserMessage message;
  EXPECT_EQ(ParseLaserLine("\t FLASER\t2   1.5\t\t2.5  0 0 0\t0 0 0   7.25 \t", &message), "");
  EXPECT_THAT(message.ranges, ElementsAre(1.5F, 2.5F));
  EXPECT_EQ(message.timestamp, 7.25);
}

TEST(ParseLaserLine, HostAndLoggerTimeAreNotNeeded) {
  CarmenLaserMessage message;
  EXPECT_EQ(ParseLaserLine("FLASER 1 1 0 0 0 0 0 0 7", &message), "");
}

TEST(ParseLaserLine, RefusesEveryLineCutBeforeTheEndOfItsTimeStamp) {
  for (const std::string& line : {kFlaserLine, kRobotLaserLine, kRawLaserLine}) {
    const std::size_t last_needed = line.rfind(" nohost");
    const std::size_t time_begin = line.rfind(' ', last_needed - 1) + 1;
    for (std::size_t size = line.find(' '); size <= time_begin; ++size) {
      CarmenLaserMessage message;
      EXPECT_NE(ParseLaserLine(line.substr(0, size), &message), "") << line.substr(0, size);
    }
  }
}

TEST(ParseLaserLine, RefusesReadingsThatAreNone) {
  for (const char* reading :
       {"nan", "NaN", "inf", "-inf", "-1", "-0.01", "1e99", "x", "1,5", "1.5m", "0x1"}) {
    CarmenLaserMessage message;
    const auto line = fmt::format("FLASER 3 1 {} 3 0 0 0 0 0 0 7 nohost 7", reading);
    EXPECT_THAT(ParseLaserLine(line, &message), HasSubstr("reading 2 of 3")) << line;
  }
}

TEST(ParseLaserLine, RefusesAbsurdCounts) {
  for (const char* count :
       {"999999999", "99999999999999999999", "-1", "0", "16385", "2.5", "x", "1e3", "nan"}) {
    CarmenLaserMessage message;
    const auto flaser = fmt::format("FLASER {} 1 2 3 0 0 0 0 0 0 7 nohost 7", count);
    EXPECT_THAT(ParseLaserLine(flaser, &message), HasSubstr("the number of readings")) << flaser;
    EXPECT_LE(message.ranges.capacity(), 4U);
  }
  CarmenLaserMessage message;
  EXPECT_THAT(ParseLaserLine("RAWLASER1 0 0 0 0.1 50 0 0 2 1 2 999999999 7 nohost 7", &message),
              HasSubstr("the number of remissions"));
  EXPECT_THAT(ParseLaserLine("RAWLASER1 0 0 0 0.1 50 0 0 2 1 2 -1 7 nohost 7", &message),
              HasSubstr("the number of remissions"));
}

TEST(ParseLaserLine, RefusesPosesAndTimesThatAreNotFiniteOrAbsurd) {
  for (const char* number : {"nan", "inf", "-inf", "1e8", "-1e8", "x", "1e999"}) {
    for (int field = 0; field < 6; ++field) {
      std::string line = "FLASER 1 1";
      for (int i = 0; i < 6; ++i) line += i == field ? std::string(" ") + number : " 0";
      CarmenLaserMessage message;
      EXPECT_THAT(ParseLaserLine(line + " 7 nohost 7", &message),
                  HasSubstr(field < 3 ? "the pose of the laser" : "the pose of the robot"))
          << line;
    }
  }
  CarmenLaserMessage message;
  EXPECT_THAT(ParseLaserLine("FLASER 1 1 0 0 0 0 0 0 nan nohost 7", &message),
              HasSubstr("time stamp"));
  EXPECT_THAT(ParseLaserLine("FLASER 1 1 0 0 0 0 0 0 nohost 7", &message), HasSubstr("time stamp"));
}

TEST(ParseLaserLine, RefusesAConfigurationOutOfBounds) {
  for (const char* configuration :
       {"0 nan 3 0.1 50 0 0", "0 0 inf 0.1 50 0 0", "0 -7 3 0.1 50 0 0", "0 0 -1 0.1 50 0 0",
        "0 0 7 0.1 50 0 0", "0 0 3 9 50 0 0", "0 0 3 0.1 -50 0 0", "0 0 3 0.1 50 0 x"}) {
    CarmenLaserMessage message;
    const auto line = fmt::format("RAWLASER1 {} 2 1 2 0 7 nohost 7", configuration);
    EXPECT_THAT(ParseLaserLine(line, &message), HasSubstr("the laser's")) << line;
  }
}

TEST(ParseLaserLine, BringsReadingsFromBeyondAnyLaserDownToTheFarthest) {
  CarmenLaserMessage message;
  ASSERT_EQ(ParseLaserLine("FLASER 4 9999 10001 1e30 1e-30 0 0 0 0 0 0 7", &message), "");
  EXPECT_THAT(message.ranges, ElementsAre(9999.0F, kFarthestReading, kFarthestReading, 1e-30F));
}

TEST(ParseLaserLine, TakesTheMostReadings) {
  std::string line = "FLASER 16384";
  for (int i = 0; i < kMaxReadings; ++i) line += " 1";
  CarmenLaserMessage message;
  EXPECT_EQ(ParseLaserLine(line + " 0 0 0 0 0 0 7", &message), "");
  EXPECT_EQ(message.ranges.size(), 16384U);
}

TEST(ParseOdometryLine, ReadsThePose) {
  SE2 pose;
  EXPECT_EQ(ParseOdometryLine("ODOM 1.5 -2 0.25 0.3 0 0 100.25 nohost 0.5", &pose), "");
  EXPECT_EQ(pose.coordinates(), Eigen::Vector3d(1.5, -2.0, 0.25));
}

TEST(ParseOdometryLine, RefusesWhatIsNoPose) {
  for (const char* line : {"ODOM", "ODOM 1 2", "ODOM 1 2 nan 0", "ODOM inf 2 3 0", "ODOM 1 2 1e6",
                           "ODOM 1e9 2 3", "ODOM a b c"}) {
    SE2 pose;
    EXPECT_THAT(ParseOdometryLine(line, &pose), HasSubstr("the pose of the robot")) << line;
  }
}

}  // namespace
}  // namespace loopgrid
