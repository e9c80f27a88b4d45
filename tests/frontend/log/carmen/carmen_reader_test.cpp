#include "frontend/log/carmen/carmen_reader.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include "backend/base/gzip.h"
#include "tests/frontend/log/log_testing.h"

namespace loopgrid {
namespace {

using test_support::MemoryFile;
using test_support::ReadWholeLog;
using test_support::ReadWholeLogFrom;
using test_support::WholeLog;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

// A FLASER line; the laser's pose is the robot's times the mount.
std::string Flaser(const std::vector<double>& ranges, const SE2& robot, double time,
                   const SE2& mount = SE2()) {
  std::string line = fmt::format("FLASER {}", ranges.size());
  for (const double range : ranges) line += fmt::format(" {}", range);
  const SE2 laser = robot * mount;
  line += fmt::format(" {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {} nohost {}\n", laser.x(),
                      laser.y(), laser.theta(), robot.x(), robot.y(), robot.theta(), time, time);
  return line;
}

std::vector<double> Times(const WholeLog& log) {
  std::vector<double> times;
  for (const Observation& observation : log.observations) times.push_back(observation.timestamp);
  return times;
}

const std::string kSmallLog =
    "# message formats\n"
    "PARAM robot_frontlaser_offset 0.25 nohost 0\n"
    "SYNC tag 0.1 nohost 0.1\n" +
    Flaser({1.0, 2.0}, SE2(1, 2, 0.5), 10.5) + "ODOM 1 2 0.5 0 0 0 10.6 nohost 10.6\n" +
    Flaser({3.0, 4.0}, SE2(1.5, 2, 0.5), 11.5);

void ExpectSmallLog(const WholeLog& log) {
  ASSERT_EQ(log.observations.size(), 2U);
  const Observation& first = log.observations[0];
  EXPECT_EQ(first.timestamp, 10.5);
  EXPECT_EQ(first.T_odom_robot.coordinates(), Eigen::Vector3d(1.0, 2.0, 0.5));
  EXPECT_EQ(first.scan.T_robot_laser.coordinates(), Eigen::Vector3d(0.25, 0.0, 0.0));
  EXPECT_THAT(first.scan.ranges, ElementsAre(1.0F, 2.0F));
  EXPECT_THAT(log.observations[1].scan.ranges, ElementsAre(3.0F, 4.0F));
  EXPECT_EQ(log.statistics.lines, 6);
  EXPECT_EQ(log.statistics.scans, 2);
  EXPECT_EQ(log.statistics.odometry, 1);
  EXPECT_EQ(log.statistics.parameters, 1);
  EXPECT_EQ(log.statistics.ignored, 2);
  EXPECT_EQ(log.statistics.malformed, 0);
}

std::string WithCrLf(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return result;
}

TEST(CarmenReader, ReadsASmallLog) { ExpectSmallLog(ReadWholeLogFrom(kSmallLog)); }

TEST(CarmenReader, TakesCrLfGzipAndAByteOrderMark) {
  ExpectSmallLog(ReadWholeLogFrom(WithCrLf(kSmallLog)));
  ExpectSmallLog(ReadWholeLogFrom(Gzip(kSmallLog)));
  ExpectSmallLog(ReadWholeLogFrom(Gzip(WithCrLf(kSmallLog))));
  ExpectSmallLog(ReadWholeLogFrom("\xEF\xBB\xBF" + kSmallLog));
}

TEST(CarmenReader, TakesALastLineWithoutItsEndIfNothingNeededIsAtStake) {
  ExpectSmallLog(ReadWholeLogFrom(kSmallLog.substr(0, kSmallLog.size() - 1)));
}

TEST(CarmenReader, ALogCutAnywhereGivesTheScansBeforeTheCut) {
  const std::size_t first_end = kSmallLog.find("ODOM");
  const std::size_t second_begin = kSmallLog.rfind("FLASER");
  const std::size_t second_end = kSmallLog.rfind("nohost");  // a blank ends the time stamp
  for (std::size_t size = 1; size <= kSmallLog.size(); ++size) {
    SCOPED_TRACE(size);
    const WholeLog log = ReadWholeLogFrom(kSmallLog.substr(0, size));
    if (size >= second_end) {
      EXPECT_THAT(Times(log), ElementsAre(10.5, 11.5));
    } else if (size >= first_end) {
      EXPECT_THAT(Times(log), ElementsAre(10.5));
    } else if (size < second_begin) {
      EXPECT_LE(log.observations.size(), 1U);
    }
  }
}

TEST(CarmenReader, FileOrderHoldsWhenTheClockRunsBackwards) {
  std::string content;
  for (const double time : {5.0, 3.0, 4.0, 4.0, -1.0}) content += Flaser({1.0}, SE2(), time);
  EXPECT_THAT(Times(ReadWholeLogFrom(content)), ElementsAre(5.0, 3.0, 4.0, 4.0, -1.0));
}

TEST(CarmenReader, SkipsCountsAndReportsMalformedLines) {
  const std::string content = "FLASER 999999999 1 2 3\n" + Flaser({1.0}, SE2(), 1.0) +
                              "FLASER -1 0 0 0 0 0 0 2 nohost 2\n"
                              "FLASER 2 1 nan 0 0 0 0 0 0 3 nohost 3\n"
                              "FLASER 1 -1 0 0 0 0 0 0 4 nohost 4\n"
                              "ODOM 1 inf 0\n" +
                              Flaser({2.0}, SE2(), 5.0);
  const MemoryFile file(content);
  LogReaderOptions options;
  options.max_reported_problems = 3;
  const WholeLog log = ReadWholeLog(file.path(), options);
  EXPECT_THAT(Times(log), ElementsAre(1.0, 5.0));
  EXPECT_EQ(log.statistics.malformed, 5);
  EXPECT_THAT(
      log.statistics.first_problems,
      ElementsAre(HasSubstr(":1: the number of readings is 999999999"),
                  HasSubstr(":3: the number of readings is -1"), HasSubstr(":4: reading 2 of 2")));
  EXPECT_EQ(log.statistics.first_problems[0].find(file.path() + ":1: "), 0U);
}

TEST(CarmenReader, StrictModeStopsAtTheFirstMalformedLine) {
  const MemoryFile file(Flaser({1.0}, SE2(), 1.0) + "FLASER 1\n" + Flaser({1.0}, SE2(), 2.0));
  LogReaderOptions options;
  options.strict = true;
  const auto reader = OpenLog(file.path(), options);
  Observation observation;
  EXPECT_TRUE(reader->Next(&observation));
  EXPECT_THAT([&] { reader->Next(&observation); },
              ThrowsMessage<Error>(HasSubstr(file.path() + ":2: reading 1 of 1")));
}

TEST(CarmenReader, ALineTooLongIsMalformed) {
  const std::string content =
      "FLASER 2 " + std::string(LineReader::kMaxLineLength, '1') + "\n" + Flaser({1.0}, SE2(), 1.0);
  const WholeLog log = ReadWholeLogFrom(content);
  EXPECT_THAT(Times(log), ElementsAre(1.0));
  EXPECT_THAT(log.statistics.first_problems, ElementsAre(EndsWith(":1: the line is too long")));
}

TEST(CarmenReader, TheBeamCountMayChangeInMidLog) {
  const std::string content = Flaser(std::vector<double>(181, 1.0), SE2(), 1.0) +
                              Flaser(std::vector<double>(361, 1.0), SE2(), 2.0) +
                              Flaser(std::vector<double>(180, 1.0), SE2(), 3.0);
  const WholeLog log = ReadWholeLogFrom(content);
  ASSERT_EQ(log.observations.size(), 3U);
  constexpr double kRadians = std::numbers::pi / 180.0;
  const double steps[] = {1.0, 0.5, 1.0};
  const std::size_t counts[] = {181, 361, 180};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(log.observations[i].scan.ranges.size(), counts[i]);
    EXPECT_NEAR(log.observations[i].scan.angle_step, steps[i] * kRadians, 1e-12);
    EXPECT_NEAR(log.observations[i].scan.first_angle, -90.0 * kRadians, 1e-12);
  }
}

TEST(CarmenReader, ParametersHoldFromTheirLineOn) {
  const std::string content =
      Flaser({1.0}, SE2(), 1.0) + "PARAM robot_frontlaser_offset 0.5 nohost 0\n" +
      Flaser({1.0}, SE2(), 2.0) + "PARAM robot_frontlaser_offset 0.75 nohost 0\n" +
      Flaser({1.0}, SE2(), 3.0);
  const WholeLog log = ReadWholeLogFrom(content);
  ASSERT_EQ(log.observations.size(), 3U);
  EXPECT_EQ(log.observations[0].scan.T_robot_laser.x(), 0.0);
  EXPECT_EQ(log.observations[1].scan.T_robot_laser.x(), 0.5);
  EXPECT_EQ(log.observations[2].scan.T_robot_laser.x(), 0.75);
}

TEST(CarmenReader, FindsTheMountInThePairsOfPosesForTheFirstScanToo) {
  const SE2 mount(0.3, 0.05, -0.1);
  std::string content;
  for (int i = 0; i < 40; ++i) {
    content += Flaser({1.0}, SE2(0.05 * i, 0.01 * i, 0.04 * i), i, mount);
  }
  const WholeLog log = ReadWholeLogFrom(content);
  ASSERT_EQ(log.observations.size(), 40U);
  for (const Observation& observation : log.observations) {
    EXPECT_LT(observation.scan.T_robot_laser.Boxminus(mount).norm(), 1e-5);
  }
  EXPECT_EQ(Times(log)[7], 7.0);
}

TEST(CarmenReader, TakesTheMountOnTrustInALogTooShortToProveIt) {
  const SE2 mount(0.3, 0.0, 0.0);
  const WholeLog log = ReadWholeLogFrom(Flaser({1.0}, SE2(1, 2, 0.5), 1.0, mount));
  ASSERT_EQ(log.observations.size(), 1U);
  EXPECT_LT(log.observations[0].scan.T_robot_laser.Boxminus(mount).norm(), 1e-5);
}

TEST(CarmenReader, CorrectedPosesOfAnotherMapperAreNotTakenForAMount) {
  std::string content;
  for (int i = 0; i < 40; ++i) {
    const SE2 robot(0.05 * i, 0.01 * i, 0.04 * i);
    const SE2 corrected = SE2(0.2, 0.1, 0.05) * robot.Boxplus({0.001 * i, 0.0, 0.002 * i});
    content += Flaser({1.0}, robot, i, robot.Inverse() * corrected);
  }
  for (const Observation& observation : ReadWholeLogFrom(content).observations) {
    EXPECT_EQ(observation.scan.T_robot_laser.coordinates(), Eigen::Vector3d::Zero());
  }
}

TEST(CarmenReader, AStatedMountIsNotWaitedFor) {
  const MemoryFile file("PARAM robot_frontlaser_offset 0.3 nohost 0\n" +
                        Flaser({1.0}, SE2(1, 2, 0.5), 1.0, SE2(0.4, 0.0, 0.0)));
  const WholeLog log = ReadWholeLog(file.path());
  EXPECT_EQ(log.observations.at(0).scan.T_robot_laser.x(), 0.3);
}

TEST(CarmenReader, ALogOfARearLaserOnlyGivesItsScans) {
  const WholeLog log = ReadWholeLogFrom(
      "PARAM robot_rearlaser_offset -0.3 nohost 0\nRLASER 2 1 2 0 0 0 5 6 0.5 7 nohost 7\n");
  ASSERT_EQ(log.observations.size(), 1U);
  const LaserScan& scan = log.observations[0].scan;
  EXPECT_EQ(scan.T_robot_laser.x(), -0.3);
  EXPECT_NEAR(std::abs(scan.T_robot_laser.theta()), std::numbers::pi, 1e-12);
  EXPECT_EQ(log.observations[0].T_odom_robot.x(), 5.0);
}

TEST(CarmenReader, TheFrontLaserIsPreferredToTheRearOne) {
  std::string content;
  for (int i = 0; i < 4; ++i) {
    content += Flaser({1.0}, SE2(), i) + fmt::format("RLASER 1 2 0 0 0 0 0 0 {} nohost 7\n", i);
  }
  const WholeLog log = ReadWholeLogFrom(content);
  EXPECT_THAT(Times(log), ElementsAre(0.0, 1.0, 2.0, 3.0));
  EXPECT_EQ(log.statistics.ignored, 4);
}

TEST(CarmenReader, ChangingTheLaserKeepsTheScansHeldBackAndTheirMount) {
  const SE2 mount(0.3, 0.0, 0.2);
  std::string rear = Flaser({2.0}, SE2(1, 2, 0.5), 1.0, mount);
  rear.replace(0, 6, "RLASER");
  const WholeLog log = ReadWholeLogFrom(rear + Flaser({1.0}, SE2(1, 2, 0.5), 2.0));
  EXPECT_THAT(Times(log), ElementsAre(1.0, 2.0));
  EXPECT_LT(log.observations[0].scan.T_robot_laser.Boxminus(mount).norm(), 1e-5);
  EXPECT_EQ(log.observations[1].scan.T_robot_laser.x(), 0.0);
}

TEST(CarmenReader, ReadsALogOfRawScansAndOdometry) {
  const WholeLog log = ReadWholeLogFrom(
      "ODOM 1 2 0.5 0 0 0 1 nohost 1\n"
      "RAWLASER1 0 -1.570796 3.141593 0.017453 81.83 0.01 0 2 4 5 0 1.5 nohost 1.5\n"
      "ODOM 2 2 0.5 0 0 0 2 nohost 2\n"
      "RAWLASER1 0 -1.570796 3.141593 0.017453 81.83 0.01 0 2 6 7 0 2.5 nohost 2.5\n");
  ASSERT_EQ(log.observations.size(), 2U);
  EXPECT_EQ(log.observations[0].T_odom_robot.coordinates(), Eigen::Vector3d(1, 2, 0.5));
  EXPECT_EQ(log.observations[1].T_odom_robot.coordinates(), Eigen::Vector3d(2, 2, 0.5));
  EXPECT_EQ(log.observations[1].scan.first_angle, -1.570796);
  EXPECT_EQ(log.observations[1].scan.max_range, 81.83);
  EXPECT_EQ(log.statistics.odometry, 2);
}

TEST(CarmenReader, CutGzipDataGiveWhatComesBeforeAndCount) {
  std::string content;
  for (int i = 0; i < 2'000; ++i) content += Flaser({1.0 + i % 7, 2.0}, SE2(0.1 * i, 0, 0), i);
  const std::string packed = Gzip(content);
  const MemoryFile file(packed.substr(0, packed.size() / 2));
  const WholeLog log = ReadWholeLog(file.path());
  EXPECT_GT(log.observations.size(), 500U);
  EXPECT_LT(log.observations.size(), 1'500U);
  EXPECT_THAT(log.statistics.first_problems.back(), HasSubstr("the gzip data are cut short"));
  LogReaderOptions strict;
  strict.strict = true;
  EXPECT_THAT([&] { ReadWholeLog(file.path(), strict); },
              ThrowsMessage<Error>(HasSubstr("the gzip data are cut short")));
}

TEST(CarmenReader, ProgressReachesOne) {
  const MemoryFile file(kSmallLog);
  const auto reader = OpenLog(file.path());
  Observation observation;
  while (reader->Next(&observation)) {
  }
  EXPECT_EQ(reader->progress(), 1.0);
}

}  // namespace
}  // namespace loopgrid
