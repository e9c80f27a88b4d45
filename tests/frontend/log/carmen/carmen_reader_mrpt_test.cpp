// The CARMEN reader against MRPT's own parser of CARMEN logs.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/carmen_log_tools.h>

#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "frontend/log/carmen/carmen_format.h"
#include "frontend/log/corrected_log.h"
#include "tests/frontend/log/log_testing.h"
#include "tests/support/recordings.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservationOdometry;
using test_support::ReadWholeLog;
using test_support::WholeLog;

struct MrptScan {
  CObservation2DRangeScan::Ptr scan;
  CObservationOdometry::Ptr odometry;
};

std::vector<MrptScan> ReadWithMrpt(const std::string& path) {
  std::ifstream stream(path);
  std::vector<MrptScan> scans;
  std::vector<mrpt::obs::CObservation::Ptr> observations;
  while (mrpt::obs::carmen_log_parse_line(stream, observations, mrpt::Clock::fromDouble(0.0))) {
    MrptScan scan;
    for (const auto& observation : observations) {
      if (IS_CLASS(*observation, CObservation2DRangeScan)) {
        scan.scan = std::dynamic_pointer_cast<CObservation2DRangeScan>(observation);
      } else if (IS_CLASS(*observation, CObservationOdometry)) {
        scan.odometry = std::dynamic_pointer_cast<CObservationOdometry>(observation);
      }
    }
    if (scan.scan) scans.push_back(scan);
  }
  return scans;
}

// Times are not compared, because MRPT's parser reads the seconds in another unit. MRPT takes the
// difference of the two poses for the laser's mount; in a corrected log that is wrong.
void ExpectAgreement(const WholeLog& ours, const std::vector<MrptScan>& theirs, bool same_mount) {
  ASSERT_EQ(ours.observations.size(), theirs.size());
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    SCOPED_TRACE(i);
    const Observation& observation = ours.observations[i];
    const CObservation2DRangeScan& scan = *theirs[i].scan;
    ASSERT_EQ(observation.scan.ranges.size(), scan.getScanSize());
    for (std::size_t k = 0; k < scan.getScanSize(); ++k) {
      ASSERT_EQ(observation.scan.ranges[k], scan.getScanRange(k)) << k;
    }
    const auto& odometry = theirs[i].odometry->odometry;
    ASSERT_NEAR(observation.T_odom_robot.x(), odometry.x(), 1e-12);
    ASSERT_NEAR(observation.T_odom_robot.y(), odometry.y(), 1e-12);
    ASSERT_NEAR(NormalizeAngle(observation.T_odom_robot.theta() - odometry.phi()), 0.0, 1e-12);
    if (!same_mount) continue;
    ASSERT_NEAR(observation.scan.T_robot_laser.x(), scan.sensorPose.x(), 1e-5);
    ASSERT_NEAR(observation.scan.T_robot_laser.y(), scan.sensorPose.y(), 1e-5);
    ASSERT_NEAR(observation.scan.T_robot_laser.theta(), scan.sensorPose.yaw(), 1e-5);
  }
}

class RecordedLines : public ::testing::TestWithParam<const char*> {};

TEST_P(RecordedLines, ReadAsMrptReadsThem) {
  LOOPGRID_REQUIRE_RECORDING(path, std::string("logs/") + GetParam() + ".clf");
  ExpectAgreement(ReadWholeLog(path), ReadWithMrpt(path), true);
}

INSTANTIATE_TEST_SUITE_P(Shared, RecordedLines,
                         ::testing::Values("intel", "killian", "aces", "fhw", "seattle",
                                           "acapulco"));

TEST(CarmenReaderMrpt, AgreesOnAMountedLaser) {
  const test_support::TemporaryDirectory directory;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 80.0);
  const SE2 mount(0.78, -0.1, 0.2);
  std::string flaser;
  std::string robot_laser;
  for (int i = 0; i < 60; ++i) {
    Observation observation;
    observation.timestamp = 1000.0 + i;
    observation.T_odom_robot = SE2(0.1 * i, 0.02 * i, 0.05 * i);
    observation.scan.first_angle = -1.5;
    observation.scan.angle_step = 0.01;
    observation.scan.max_range = 81.0;
    const SE2 laser = observation.T_odom_robot * mount;
    std::string readings;
    for (int k = 0; k < 181; ++k) {
      observation.scan.ranges.push_back(static_cast<float>(uniform(random)));
      readings += fmt::format(" {}", observation.scan.ranges.back());
    }
    flaser += fmt::format("FLASER 181{} {} {} {} nohost {}\n", readings, CarmenPose(laser),
                          CarmenPose(observation.T_odom_robot), observation.timestamp, i);
    robot_laser += CarmenRobotLaserLine(true, observation, laser, i);
  }
  for (const std::string& content : {flaser, robot_laser}) {
    const std::string path = directory.Write("log.clf", content);
    const WholeLog ours = ReadWholeLog(path);
    ASSERT_EQ(ours.observations.size(), 60U);
    ExpectAgreement(ours, ReadWithMrpt(path), true);
  }
}

TEST(CarmenReaderMrpt, BothReadTheCorrectedLogOfARawlog) {
  const test_support::TemporaryDirectory directory;
  const std::string rawlog =
      test_support::MrptDataset("2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog");
  const WholeLog input = ReadWholeLog(rawlog);
  ASSERT_EQ(input.observations.size(), 225U);
  std::vector<CorrectedScan> scans;
  for (std::size_t i = 0; i < input.observations.size(); ++i) {
    const Observation& observation = input.observations[i];
    const SE2 drift(0.001 * static_cast<double>(i), 0.0, 0.002 * static_cast<double>(i));
    scans.push_back({drift * observation.T_odom_robot, observation.scan.T_robot_laser});
  }
  const std::string path = directory.File("corrected.clf");
  WriteCorrectedLog(rawlog, path, scans);
  const WholeLog output = ReadWholeLog(path);
  ExpectAgreement(output, ReadWithMrpt(path), false);
  for (std::size_t i = 0; i < input.observations.size(); ++i) {
    const Observation& before = input.observations[i];
    const Observation& after = output.observations[i];
    ASSERT_EQ(after.scan.ranges, before.scan.ranges);
    ASSERT_NEAR(after.scan.first_angle, before.scan.first_angle, 1e-8);
    ASSERT_NEAR(after.scan.angle_step, before.scan.angle_step, 1e-8);
    ASSERT_NEAR(after.timestamp, before.timestamp, 1e-6);
    ASSERT_LT(after.T_odom_robot.Boxminus(before.T_odom_robot).norm(), 3e-6);
    ASSERT_LT(after.scan.T_robot_laser.Boxminus(before.scan.T_robot_laser).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace loopgrid
