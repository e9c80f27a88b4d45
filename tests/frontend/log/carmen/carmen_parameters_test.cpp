#include "frontend/log/carmen/carmen_parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>

namespace loopgrid {
namespace {

using ::testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180.0;

std::string Apply(CarmenParameters* parameters, std::string_view line) {
  bool known = false;
  std::string problem = parameters->Apply(line, &known);
  EXPECT_TRUE(known) << line;
  return problem;
}

CarmenLaserMessage FlaserMessage(std::size_t count) {
  CarmenLaserMessage message;
  message.tag = CarmenTag::kFlaser;
  message.ranges.assign(count, 1.0F);
  return message;
}

TEST(BeamAnglesOf, TheResolutionParameterOverrides) {
  CarmenParameters parameters;
  EXPECT_EQ(Apply(&parameters, "PARAM laser_front_laser_resolution 0.5 nohost 0"), "");
  for (const auto& [count, first] :
       {std::pair{361, -90.0}, {360, -90.0}, {181, -45.0}, {541, -135.0}, {201, -50.0}}) {
    const BeamAngles angles = BeamAnglesOf(FlaserMessage(static_cast<std::size_t>(count)),
                                           parameters.Of(CarmenTag::kFlaser));
    EXPECT_NEAR(angles.step, 0.5 * kDegree, 1e-12);
    EXPECT_NEAR(angles.first, first * kDegree, 1e-12) << count;
  }
}

TEST(BeamAnglesOf, AResolutionThatLeadsRoundMoreThanOnceIsPassedOver) {
  CarmenParameters parameters;
  EXPECT_EQ(Apply(&parameters, "PARAM laser_front_laser_resolution 10"), "");
  const BeamAngles angles = BeamAnglesOf(FlaserMessage(181), parameters.Of(CarmenTag::kFlaser));
  EXPECT_NEAR(angles.step, 1.0 * kDegree, 1e-12);
}

TEST(BeamAnglesOf, RobotLaserStatesItsOwn) {
  CarmenParameters parameters;
  EXPECT_EQ(Apply(&parameters, "PARAM laser_front_laser_resolution 0.5"), "");
  CarmenLaserMessage message = FlaserMessage(5);
  message.tag = CarmenTag::kRobotLaser1;
  message.has_angles = true;
  message.start_angle = -1.0;
  message.field_of_view = 2.0;
  message.angular_resolution = 0.25;
  BeamAngles angles = BeamAnglesOf(message, parameters.Of(message.tag));
  EXPECT_EQ(angles.first, -1.0);
  EXPECT_EQ(angles.step, 0.25);
  message.angular_resolution = 0.0;  // then the field of view decides
  angles = BeamAnglesOf(message, parameters.Of(message.tag));
  EXPECT_EQ(angles.first, -1.0);
  EXPECT_EQ(angles.step, 0.5);
  message.field_of_view = 2.5;
  message.ranges.resize(10);  // with an even count the last beam is missing
  EXPECT_EQ(BeamAnglesOf(message, parameters.Of(message.tag)).step, 0.25);
  message.ranges.resize(5);
  message.field_of_view = 0.0;  // then the count decides
  angles = BeamAnglesOf(message, parameters.Of(message.tag));
  EXPECT_NEAR(angles.first, -90.0 * kDegree, 1e-12);
  EXPECT_NEAR(angles.step, 45.0 * kDegree, 1e-12);
}

TEST(CarmenParameters, PutTheLasersInTheRobotsCentreByDefault) {
  const CarmenParameters parameters;
  for (const CarmenTag tag : {CarmenTag::kFlaser, CarmenTag::kRobotLaser1, CarmenTag::kRawLaser3}) {
    EXPECT_EQ(parameters.Of(tag).T_robot_laser().coordinates(), Eigen::Vector3d::Zero());
    EXPECT_FALSE(parameters.Of(tag).has_mount);
  }
  const SE2 rear = parameters.Of(CarmenTag::kRlaser).T_robot_laser();
  EXPECT_EQ(rear.translation(), Eigen::Vector2d::Zero());
  EXPECT_NEAR(std::abs(rear.theta()), std::numbers::pi, 1e-12);
}

TEST(CarmenParameters, TellTheLasersApart) {
  CarmenParameters parameters;
  EXPECT_EQ(Apply(&parameters, "PARAM robot_frontlaser_offset 0.3 nohost 0"), "");
  EXPECT_EQ(Apply(&parameters, "PARAM robot_frontlaser_side_offset -0.1 nohost 0"), "");
  EXPECT_EQ(Apply(&parameters, "PARAM robot_frontlaser_angular_offset 0.2 nohost 0"), "");
  EXPECT_EQ(Apply(&parameters, "PARAM robot_rearlaser_offset -0.4 nohost 0"), "");
  EXPECT_EQ(Apply(&parameters, "PARAM robot_front_laser_max 30 nohost 0"), "");
  EXPECT_EQ(Apply(&parameters, "PARAM robot_rear_laser_max 20 nohost 0"), "");
  for (const CarmenTag tag : {CarmenTag::kFlaser, CarmenTag::kRobotLaser1, CarmenTag::kRawLaser1}) {
    EXPECT_EQ(parameters.Of(tag).T_robot_laser().coordinates(), Eigen::Vector3d(0.3, -0.1, 0.2));
    EXPECT_TRUE(parameters.Of(tag).has_mount);
    EXPECT_EQ(parameters.Of(tag).max_range, 30.0);
  }
  for (const CarmenTag tag : {CarmenTag::kRlaser, CarmenTag::kRobotLaser2, CarmenTag::kRawLaser2}) {
    EXPECT_EQ(parameters.Of(tag).T_robot_laser().x(), -0.4);
    EXPECT_TRUE(parameters.Of(tag).has_mount);
    EXPECT_EQ(parameters.Of(tag).max_range, 20.0);
  }
  EXPECT_FALSE(parameters.Of(CarmenTag::kRawLaser3).has_mount);
}

TEST(CarmenParameters, AnOffsetOfZeroStatesNoMount) {
  CarmenParameters parameters;
  EXPECT_EQ(Apply(&parameters, "PARAM robot_frontlaser_offset 0.0 nohost 0"), "");
  EXPECT_FALSE(parameters.Of(CarmenTag::kFlaser).has_mount);
}

TEST(CarmenParameters, PassOverWhatIsNotAboutALaser) {
  CarmenParameters parameters;
  for (const char* line :
       {"PARAM robot_max_t_vel 1.2 nohost 0", "PARAM", "PARAM x",
        "PARAM laser_front_laser_dev /dev/ttyS0 nohost 0", "PARAM robot_frontlaser_offsets x"}) {
    bool known = true;
    EXPECT_EQ(parameters.Apply(line, &known), "");
    EXPECT_FALSE(known) << line;
  }
}

TEST(CarmenParameters, RefuseNonsenseAndKeepWhatTheyHad) {
  CarmenParameters parameters;
  EXPECT_EQ(Apply(&parameters, "PARAM robot_frontlaser_offset 0.3"), "");
  for (const char* value : {"", "x", "nan", "inf", "1e9", "-1e9"}) {
    EXPECT_THAT(Apply(&parameters, std::string("PARAM robot_frontlaser_offset ") + value),
                HasSubstr("robot_frontlaser_offset is not a number from -100"));
  }
  EXPECT_THAT(Apply(&parameters, "PARAM laser_front_laser_resolution -1"), HasSubstr("resolution"));
  EXPECT_THAT(Apply(&parameters, "PARAM robot_front_laser_max -1"), HasSubstr("max"));
  EXPECT_EQ(parameters.Of(CarmenTag::kFlaser).x, 0.3);
}

}  // namespace
}  // namespace loopgrid
