#include "frontend/log/carmen/carmen_format.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "frontend/log/carmen/carmen_parameters.h"

namespace loopgrid {
namespace {

using ::testing::ElementsAre;

Observation SomeObservation() {
  Observation observation;
  observation.timestamp = 976052857.767368;
  observation.T_odom_robot = SE2(1.25, -2.5, 0.75);
  observation.scan.first_angle = -0.5;
  observation.scan.angle_step = 0.25;
  observation.scan.max_range = 81.83;
  observation.scan.ranges = {1.07F, 0.1F, 16777.216F, 3.0F, 1e-7F};
  return observation;
}

TEST(CarmenPose, IsThreeNumbers) {
  EXPECT_EQ(CarmenPose(SE2(1.5, -2.0, 0.1234567)), "1.500000 -2.000000 0.123457");
}

TEST(CarmenMountLines, ReadBackAsTheSameMount) {
  const SE2 mount(0.78, -0.05, 0.125);
  for (const bool front : {true, false}) {
    CarmenParameters parameters;
    std::string lines = CarmenMountLines(front, mount);
    while (!lines.empty()) {
      const std::size_t end = lines.find('\n');
      bool known = false;
      EXPECT_EQ(parameters.Apply(lines.substr(0, end), &known), "");
      EXPECT_TRUE(known);
      lines.erase(0, end + 1);
    }
    const auto& laser = parameters.Of(front ? CarmenTag::kFlaser : CarmenTag::kRlaser);
    EXPECT_EQ(laser.T_robot_laser().coordinates(), mount.coordinates());
  }
}

TEST(CarmenRobotLaserLine, ReadsBackToTheLastBit) {
  const Observation observation = SomeObservation();
  const SE2 laser(10.0, 20.0, -3.0);
  for (const bool front : {true, false}) {
    std::string line = CarmenRobotLaserLine(front, observation, laser, 12.5);
    ASSERT_EQ(line.back(), '\n');
    line.pop_back();
    CarmenLaserMessage message;
    ASSERT_EQ(ParseLaserLine(line, &message), "");
    EXPECT_EQ(message.tag, front ? CarmenTag::kRobotLaser1 : CarmenTag::kRobotLaser2);
    EXPECT_EQ(message.ranges, (std::vector<float>{1.07F, 0.1F, kFarthestReading, 3.0F, 1e-7F}));
    EXPECT_EQ(message.start_angle, -0.5);
    EXPECT_EQ(message.angular_resolution, 0.25);
    EXPECT_EQ(message.field_of_view, 1.0);
    EXPECT_EQ(message.max_range, 81.83);
    EXPECT_EQ(message.T_odom_laser.coordinates(), laser.coordinates());
    EXPECT_EQ(message.T_odom_robot.coordinates(), observation.T_odom_robot.coordinates());
    EXPECT_EQ(message.timestamp, observation.timestamp);
  }
}

TEST(CarmenRobotLaserLine, TurnsAClockwiseScanRound) {
  Observation observation = SomeObservation();
  observation.scan.first_angle = 0.5;
  observation.scan.angle_step = -0.25;
  observation.scan.ranges = {1.0F, 2.0F, 3.0F};
  CarmenLaserMessage message;
  ASSERT_EQ(ParseLaserLine(CarmenRobotLaserLine(true, observation, SE2(), 0.0), &message), "");
  EXPECT_THAT(message.ranges, ElementsAre(3.0F, 2.0F, 1.0F));
  EXPECT_EQ(message.start_angle, 0.0);
  EXPECT_EQ(message.angular_resolution, 0.25);
}

}  // namespace
}  // namespace loopgrid
