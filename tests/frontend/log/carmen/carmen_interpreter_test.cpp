#include "frontend/log/carmen/carmen_interpreter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace loopgrid {
namespace {

using ::testing::HasSubstr;

CarmenMeaning Read(CarmenInterpreter* interpreter, std::string_view line) {
  return interpreter->Read(line, true);
}

constexpr const char* kFlaser = "FLASER 1 1 0 0 0 1 2 0.5 10 nohost 10";
constexpr const char* kRlaser = "RLASER 1 2 0 0 0 3 4 0.5 10 nohost 10";
constexpr const char* kRobotLaser1 =
    "ROBOTLASER1 0 -1 2 0.5 50 0 0 1 3 0 0 0 0 5 6 0.5 0 0 0 0 0 10 nohost 10";
constexpr const char* kRawLaser1 = "RAWLASER1 0 -1 2 0.5 50 0 0 1 4 0 10 nohost 10";

TEST(CarmenInterpreter, TellsTheLinesApart) {
  CarmenInterpreter interpreter;
  EXPECT_EQ(Read(&interpreter, "# FLASER"), CarmenMeaning::kNothing);
  EXPECT_EQ(Read(&interpreter, ""), CarmenMeaning::kNothing);
  EXPECT_EQ(Read(&interpreter, "# loopgrid new-session"), CarmenMeaning::kNewSession);
  EXPECT_EQ(Read(&interpreter, "# loopgrid new-sessions"), CarmenMeaning::kNothing);
  EXPECT_EQ(Read(&interpreter, "SYNC x 0 nohost 0"), CarmenMeaning::kNothing);
  EXPECT_EQ(Read(&interpreter, "PARAM robot_width 0.5 nohost 0"), CarmenMeaning::kNothing);
  EXPECT_EQ(Read(&interpreter, "PARAM robot_frontlaser_offset 0.5"), CarmenMeaning::kParameter);
  EXPECT_EQ(Read(&interpreter, "ODOM 1 2 0.5 0 0 0 9 nohost 9"), CarmenMeaning::kOdometry);
  EXPECT_EQ(Read(&interpreter, kFlaser), CarmenMeaning::kScan);
  EXPECT_EQ(Read(&interpreter, "FLASER 1"), CarmenMeaning::kMalformed);
  EXPECT_THAT(interpreter.problem(), HasSubstr("reading 1 of 1"));
  EXPECT_EQ(Read(&interpreter, "ODOM 1"), CarmenMeaning::kMalformed);
  EXPECT_EQ(Read(&interpreter, "PARAM robot_frontlaser_offset x"), CarmenMeaning::kMalformed);
}

TEST(CarmenInterpreter, UsesTheBestLaserMetSoFar) {
  CarmenInterpreter interpreter;
  EXPECT_EQ(Read(&interpreter, kRawLaser1), CarmenMeaning::kScan);
  EXPECT_EQ(Read(&interpreter, kRlaser), CarmenMeaning::kScan);
  EXPECT_EQ(Read(&interpreter, kRawLaser1), CarmenMeaning::kOtherLaser);
  EXPECT_EQ(Read(&interpreter, kRobotLaser1), CarmenMeaning::kScan);
  EXPECT_EQ(Read(&interpreter, kFlaser), CarmenMeaning::kScan);
  EXPECT_EQ(Read(&interpreter, kRlaser), CarmenMeaning::kOtherLaser);
  EXPECT_EQ(Read(&interpreter, kRobotLaser1), CarmenMeaning::kOtherLaser);
  EXPECT_EQ(Read(&interpreter, kFlaser), CarmenMeaning::kScan);
}

TEST(CarmenInterpreter, AMalformedLineOfABetterLaserChangesNothing) {
  CarmenInterpreter interpreter;
  EXPECT_EQ(Read(&interpreter, kRlaser), CarmenMeaning::kScan);
  EXPECT_EQ(Read(&interpreter, "FLASER 1 x"), CarmenMeaning::kMalformed);
  EXPECT_EQ(Read(&interpreter, kRlaser), CarmenMeaning::kScan);
}

TEST(CarmenInterpreter, OfACutLineTheLastFieldDoesNotCount) {
  CarmenInterpreter interpreter;
  EXPECT_EQ(interpreter.Read("FLASER 1 1 0 0 0 1 2 0.5 1234", false), CarmenMeaning::kMalformed);
  EXPECT_EQ(interpreter.Read("FLASER 1 1 0 0 0 1 2 0.5 1234 no", false), CarmenMeaning::kScan);
  EXPECT_EQ(interpreter.message().timestamp, 1234.0);
  EXPECT_EQ(interpreter.Read("ODOM 1 2 0.5", false), CarmenMeaning::kMalformed);
  EXPECT_EQ(interpreter.Read("FLASE", false), CarmenMeaning::kNothing);
}

TEST(CarmenInterpreter, ScansWithPosesBringTheirOdometry) {
  CarmenInterpreter interpreter;
  Read(&interpreter, "ODOM 7 7 0.1 0 0 0 9 nohost 9");
  Read(&interpreter, kFlaser);
  EXPECT_EQ(interpreter.MakeObservation().T_odom_robot.coordinates(), Eigen::Vector3d(1, 2, 0.5));
}

TEST(CarmenInterpreter, RawScansTakeTheLatestOdometry) {
  CarmenInterpreter interpreter;
  Read(&interpreter, "ODOM 1 2 0.5 0 0 0 9 nohost 9");
  Read(&interpreter, "ODOM 3 4 0.25 0 0 0 9 nohost 9");
  Read(&interpreter, kRawLaser1);
  EXPECT_EQ(interpreter.MakeObservation().T_odom_robot.coordinates(), Eigen::Vector3d(3, 4, 0.25));
  Read(&interpreter, "ODOM 5 6 0.125 0 0 0 9 nohost 9");
  Read(&interpreter, kRawLaser1);
  EXPECT_EQ(interpreter.MakeObservation().T_odom_robot.coordinates(), Eigen::Vector3d(5, 6, 0.125));
}

TEST(CarmenInterpreter, OdometryAfterTheFirstRawScansGoesOnFromTheOrigin) {
  CarmenInterpreter interpreter;
  Read(&interpreter, kRawLaser1);
  EXPECT_EQ(interpreter.MakeObservation().T_odom_robot.coordinates(), Eigen::Vector3d::Zero());
  const SE2 first(30.0, 40.0, 1.0);
  const SE2 moved(0.5, 0.25, 0.125);
  const SE2 second = first * moved;
  Read(&interpreter, "ODOM 30 40 1 0 0 0 9 nohost 9");
  Read(&interpreter, kRawLaser1);
  EXPECT_LT(interpreter.MakeObservation().T_odom_robot.coordinates().norm(), 1e-12);
  Read(&interpreter, "ODOM " + std::to_string(second.x()) + " " + std::to_string(second.y()) + " " +
                         std::to_string(second.theta()));
  Read(&interpreter, kRawLaser1);
  EXPECT_LT((interpreter.MakeObservation().T_odom_robot.coordinates() - moved.coordinates()).norm(),
            1e-5);
}

TEST(CarmenInterpreter, MakesObservations) {
  CarmenInterpreter interpreter;
  Read(&interpreter, kRobotLaser1);
  Observation observation = interpreter.MakeObservation();
  EXPECT_EQ(observation.timestamp, 10.0);
  EXPECT_EQ(observation.scan.first_angle, -1.0);
  EXPECT_EQ(observation.scan.angle_step, 0.5);
  EXPECT_EQ(observation.scan.max_range, 50.0);
  EXPECT_THAT(observation.scan.ranges, ::testing::ElementsAre(3.0F));
  Read(&interpreter, "PARAM robot_front_laser_max 30 nohost 0");
  Read(&interpreter, kFlaser);
  observation = interpreter.MakeObservation();
  EXPECT_EQ(observation.scan.max_range, 30.0);
}

}  // namespace
}  // namespace loopgrid
