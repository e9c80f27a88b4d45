#include "frontend/log/rawlog/rawlog_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "backend/base/error.h"
#include "frontend/log/rawlog/rawlog_format.h"
#include "tests/frontend/log/log_testing.h"
#include "tests/frontend/log/rawlog/rawlog_testing.h"
#include "tests/support/recordings.h"

namespace loopgrid {
namespace {

using mrpt::obs::CActionRobotMovement2D;
using mrpt::obs::CObservation2DRangeScan;
using mrpt::poses::CPose2D;
using mrpt::poses::CPose3D;
using test_support::MemoryFile;
using test_support::RawlogBytes;
using test_support::ReadWholeLog;
using test_support::ReadWholeLogFrom;
using test_support::Scan;
using test_support::SmallRawlog;
using test_support::WholeLog;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

constexpr double kRawlogPi = std::numbers::pi;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

WholeLog ReadAll(const RawlogBytes& bytes) { return ReadWholeLogFrom(bytes.str()); }

void ExpectPose(const SE2& pose, double x, double y, double theta) {
  EXPECT_LT(pose.Boxminus(SE2(x, y, theta)).cwiseAbs().maxCoeff(), 1e-9)
      << pose.coordinates().transpose();
}

TEST(RawlogReader, AddsUpTheIncrementsOfActions) {
  RawlogBytes bytes;
  bytes.AddFrame({Scan({1.0F, 2.0F, 3.0F}, 5.0)});
  bytes.AddMovement(CPose2D(1.0, 0.0, kRawlogPi / 2.0)).AddFrame({Scan({4.0F, 5.0F, 6.0F}, 6.5)});
  bytes.AddMovement(CPose2D(2.0, 1.0, 0.0)).AddFrame({Scan({7.0F, 8.0F, 9.0F}, 6.0)});
  const WholeLog log = ReadAll(bytes);
  ASSERT_THAT(log.observations, SizeIs(3));
  ExpectPose(log.observations[0].T_odom_robot, 0.0, 0.0, 0.0);
  ExpectPose(log.observations[1].T_odom_robot, 1.0, 0.0, kRawlogPi / 2.0);
  ExpectPose(log.observations[2].T_odom_robot, 0.0, 2.0, kRawlogPi / 2.0);
  EXPECT_EQ(log.observations[1].timestamp, 6.5);
  EXPECT_THAT(log.observations[1].scan.ranges, ElementsAre(4.0F, 5.0F, 6.0F));
  EXPECT_EQ(log.statistics.lines, 5);
  EXPECT_EQ(log.statistics.odometry, 2);
  EXPECT_EQ(log.statistics.malformed, 0);
}

TEST(RawlogReader, TakesTheMeanOfAMovementThatIsNoOdometry) {
  CActionRobotMovement2D movement;
  movement.estimationMethod = CActionRobotMovement2D::emScan2DMatching;
  mrpt::poses::CPosePDFGaussian change;
  change.mean = CPose2D(0.5, 0.25, 0.125);
  movement.poseChange = mrpt::poses::CPosePDF::Ptr(new mrpt::poses::CPosePDFGaussian(change));
  mrpt::obs::CActionCollection actions;
  actions.insert(movement);
  RawlogBytes bytes;
  bytes.Add(actions).AddFrame({Scan({1.0F, 2.0F})});
  ExpectPose(ReadAll(bytes).observations.at(0).T_odom_robot, 0.5, 0.25, 0.125);
}

TEST(RawlogReader, ReadsPlainObservationsWithAbsoluteOdometry) {
  mrpt::obs::CObservationOdometry odometry;
  RawlogBytes bytes;
  odometry.odometry = CPose2D(1.0, 2.0, 0.5);
  bytes.Add(odometry).Add(Scan({1.0F, 2.0F}, 5.0));
  odometry.odometry = CPose2D(3.0, 2.0, 0.25);
  bytes.Add(odometry).Add(Scan({3.0F, 4.0F}, 6.0)).Add(mrpt::obs::CObservationComment());
  const WholeLog log = ReadAll(bytes);
  ASSERT_THAT(log.observations, SizeIs(2));
  ExpectPose(log.observations[0].T_odom_robot, 1.0, 2.0, 0.5);
  ExpectPose(log.observations[1].T_odom_robot, 3.0, 2.0, 0.25);
  EXPECT_EQ(log.statistics.odometry, 2);
  EXPECT_EQ(log.statistics.ignored, 1);
}

TEST(RawlogReader, TheOdometryOfAFrameHoldsForItsScansWhereverItStands) {
  const auto odometry = std::make_shared<mrpt::obs::CObservationOdometry>();
  odometry->odometry = CPose2D(1.0, 2.0, 0.5);
  mrpt::obs::CSensoryFrame frame;
  frame.insert(std::make_shared<CObservation2DRangeScan>(Scan({1.0F, 2.0F})));
  frame.insert(odometry);
  RawlogBytes bytes;
  bytes.Add(frame);
  ExpectPose(ReadAll(bytes).observations.at(0).T_odom_robot, 1.0, 2.0, 0.5);
}

TEST(RawlogReader, AbsoluteOdometryDoesNotMixIntoActions) {
  mrpt::obs::CObservationOdometry odometry;
  odometry.odometry = CPose2D(100.0, 0.0, 0.0);
  RawlogBytes bytes;
  bytes.AddMovement(CPose2D(1.0, 0.0, 0.0)).Add(odometry).Add(Scan({1.0F, 2.0F}));
  ExpectPose(ReadAll(bytes).observations.at(0).T_odom_robot, 1.0, 0.0, 0.0);
}

TEST(RawlogReader, SpansTheApertureInTheDirectionOfTheSweep) {
  CObservation2DRangeScan scan = Scan({1.0F, 2.0F, 3.0F});
  scan.sensorPose = CPose3D(0.78, -0.1, 0.3, 0.25, 0.0, 0.0);
  RawlogBytes bytes;
  bytes.Add(scan);
  scan.rightToLeft = false;
  bytes.Add(scan);
  const WholeLog log = ReadAll(bytes);
  ASSERT_THAT(log.observations, SizeIs(2));
  ExpectPose(log.observations[0].scan.T_robot_laser, 0.78, -0.1, 0.25);
  EXPECT_NEAR(log.observations[0].scan.first_angle, -1.0, 1e-6);
  EXPECT_NEAR(log.observations[0].scan.angle_step, 1.0, 1e-6);
  EXPECT_NEAR(log.observations[1].scan.first_angle, 1.0, 1e-6);
  EXPECT_NEAR(log.observations[1].scan.angle_step, -1.0, 1e-6);
}

TEST(RawlogReader, AnUpsideDownLaserSweepsTheOtherWay) {
  CObservation2DRangeScan scan = Scan({1.0F, 2.0F, 3.0F});
  scan.sensorPose = CPose3D(0.2, 0.1, 0.3, 0.25, 0.0, kRawlogPi);
  RawlogBytes bytes;
  bytes.Add(scan);
  const WholeLog log = ReadAll(bytes);
  ASSERT_THAT(log.observations, SizeIs(1));
  const LaserScan& ours = log.observations[0].scan;
  // Each beam has to be where MRPT's pose in space puts it.
  for (std::size_t i = 0; i < 3; ++i) {
    const double theirs = scan.getScanAngle(i);
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    scan.sensorPose.composePoint(std::cos(theirs), std::sin(theirs), 0.0, x, y, z);
    const double angle = ours.first_angle + ours.angle_step * static_cast<double>(i);
    const Eigen::Vector2d p =
        ours.T_robot_laser * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    EXPECT_NEAR(p.x(), x, 1e-6);
    EXPECT_NEAR(p.y(), y, 1e-6);
  }
}

TEST(RawlogReader, TheReadingsOfASickAreNotStretched) {
  for (const auto& [count, step] : {std::pair{180, 1.0}, {181, 1.0}, {360, 0.5}, {361, 0.5}}) {
    CObservation2DRangeScan scan = Scan(std::vector<float>(static_cast<std::size_t>(count), 1.0F));
    scan.aperture = static_cast<float>(kRawlogPi);
    RawlogBytes bytes;
    bytes.Add(scan);
    const WholeLog log = ReadAll(bytes);
    EXPECT_NEAR(log.observations.at(0).scan.angle_step, step * kRawlogPi / 180.0, 1e-6);
    EXPECT_NEAR(log.observations.at(0).scan.first_angle, -kRawlogPi / 2.0, 1e-6);
  }
}

TEST(RawlogReader, InvalidReadingsAreGivenOutAsTheMaximumRange) {
  CObservation2DRangeScan scan = Scan({1.0F, 81.83F, 0.0F, kNan, -1.0F, 29.0F});
  for (const std::size_t i : {1U, 2U, 3U, 4U}) scan.setScanRangeValidity(i, false);
  RawlogBytes bytes;
  bytes.Add(scan);
  scan.maxRange = kNan;
  bytes.Add(scan);
  const WholeLog log = ReadAll(bytes);
  ASSERT_THAT(log.observations, SizeIs(2));
  EXPECT_EQ(log.observations[0].scan.max_range, 30.0);
  EXPECT_THAT(log.observations[0].scan.ranges,
              ElementsAre(1.0F, 30.0F, 30.0F, 30.0F, 30.0F, 29.0F));
  EXPECT_EQ(log.observations[1].scan.max_range, 0.0);
  EXPECT_EQ(log.observations[1].scan.ranges[1], kFarthestReading);
}

TEST(RawlogReader, SkipsAndCountsScansThatAreWrong) {
  RawlogBytes bytes;
  bytes.Add(Scan({1.0F, kNan, 2.0F}));
  bytes.Add(Scan({1.0F, -1.0F}));
  bytes.Add(Scan({1.0F, std::numeric_limits<float>::infinity()}));
  bytes.Add(Scan({}));
  bytes.Add(Scan(std::vector<float>(20'000, 1.0F)));
  CObservation2DRangeScan scan = Scan({1.0F, 2.0F});
  for (const float aperture : {kNan, 0.0F, -1.0F, 7.0F}) {
    scan.aperture = aperture;
    bytes.Add(scan);
  }
  bytes.Add(Scan({1.0F, 2.0F}, 9.0));
  const MemoryFile file(bytes.str());
  const WholeLog log = ReadWholeLog(file.path());
  ASSERT_THAT(log.observations, SizeIs(1));
  EXPECT_EQ(log.observations[0].timestamp, 9.0);
  EXPECT_EQ(log.statistics.malformed, 9);
  EXPECT_EQ(log.statistics.first_problems.at(0),
            file.path() + ": object 1: reading 2 of 3 is not a finite number >= 0");
  LogReaderOptions strict;
  strict.strict = true;
  EXPECT_THAT([&] { ReadWholeLog(file.path(), strict); },
              ThrowsMessage<Error>(HasSubstr(": object 1: reading 2")));
}

TEST(RawlogReader, RefusesOdometryThatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  mrpt::obs::CObservationOdometry odometry;
  odometry.odometry = CPose2D(nan, 0.0, 0.0);
  RawlogBytes bytes;
  bytes.Add(odometry).Add(Scan({1.0F, 2.0F}));
  bytes.AddMovement(CPose2D(1.0, 0.0, 0.0)).AddMovement(CPose2D(nan, 0.0, 0.0));
  bytes.AddMovement(CPose2D(1e9, 0.0, 0.0)).Add(Scan({1.0F, 2.0F}));
  const WholeLog log = ReadAll(bytes);
  ASSERT_THAT(log.observations, SizeIs(2));
  ExpectPose(log.observations[0].T_odom_robot, 0.0, 0.0, 0.0);
  ExpectPose(log.observations[1].T_odom_robot, 1.0, 0.0, 0.0);
  EXPECT_EQ(log.statistics.malformed, 3);
}

TEST(RawlogReader, UsesTheFirstHorizontalLaser) {
  CObservation2DRangeScan tilted = Scan({1.0F, 1.0F});
  tilted.sensorLabel = "TILTED";
  tilted.sensorPose = CPose3D(0.0, 0.0, 1.0, 0.0, 0.5, 0.0);
  CObservation2DRangeScan front = Scan({2.0F, 2.0F});
  front.sensorLabel = "FRONT";
  CObservation2DRangeScan rear = Scan({3.0F, 3.0F});
  rear.sensorLabel = "REAR";
  CObservation2DRangeScan unlabelled = Scan({4.0F, 4.0F});
  RawlogBytes bytes;
  bytes.AddFrame({tilted, front, rear}).AddFrame({rear, unlabelled, front});
  const WholeLog log = ReadAll(bytes);
  ASSERT_THAT(log.observations, SizeIs(2));
  for (const Observation& observation : log.observations) {
    EXPECT_THAT(observation.scan.ranges, ElementsAre(2.0F, 2.0F));
  }
  EXPECT_EQ(log.statistics.ignored, 4);
}

TEST(RawlogReader, TellsLasersWithoutLabelsApartByTheirPlace) {
  CObservation2DRangeScan front = Scan({2.0F, 2.0F});
  CObservation2DRangeScan rear = Scan({3.0F, 3.0F});
  rear.sensorPose = CPose3D(-0.3, 0.0, 0.0, kRawlogPi, 0.0, 0.0);
  RawlogBytes bytes;
  bytes.AddFrame({front, rear}).AddFrame({rear, front});
  const WholeLog log = ReadAll(bytes);
  ASSERT_THAT(log.observations, SizeIs(2));
  EXPECT_EQ(log.observations[1].scan.ranges[0], 2.0F);
}

TEST(RawlogReader, AScanWithoutTimeTakesThatOfTheOneBefore) {
  CObservation2DRangeScan scan = Scan({1.0F, 2.0F});
  scan.timestamp = INVALID_TIMESTAMP;
  RawlogBytes bytes;
  bytes.Add(Scan({1.0F, 2.0F}, 5.0)).Add(scan);
  EXPECT_EQ(ReadAll(bytes).observations.at(1).timestamp, 5.0);
}

TEST(RawlogReader, IsChosenByTheFirstBytesThatMrptWrites) {
  EXPECT_TRUE(LooksLikeRawlog(SmallRawlog().str()));
}

TEST(RawlogReader, ReadsTheRecordingsThatDebianShips) {
  const WholeLog sena = ReadWholeLog(
      test_support::MrptDataset("2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog"));
  ASSERT_THAT(sena.observations, SizeIs(225));
  EXPECT_EQ(sena.statistics.odometry, 224);
  EXPECT_EQ(sena.statistics.malformed, 0);
  const LaserScan& scan = sena.observations[0].scan;
  EXPECT_THAT(scan.ranges, SizeIs(361));
  EXPECT_NEAR(scan.T_robot_laser.x(), 0.78, 1e-6);
  EXPECT_NEAR(scan.angle_step, 0.5 * kRawlogPi / 180.0, 1e-6);
  EXPECT_EQ(scan.max_range, 80.0);
  EXPECT_THAT(ReadWholeLog(test_support::MrptDataset("localization_demo.rawlog")).observations,
              SizeIs(37));
}

}  // namespace
}  // namespace loopgrid
