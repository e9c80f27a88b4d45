#include "frontend/log/corrected_log.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "backend/base/error.h"
#include "backend/base/gzip.h"
#include "frontend/log/carmen/carmen_line.h"
#include "tests/frontend/log/log_testing.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::ReadFile;
using test_support::ReadWholeLog;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

class CorrectedLogTest : public ::testing::Test {
 protected:
  // Corrects the scans of a log to the given robot poses, with the mounts as read.
  CorrectedLogStatistics Correct(const std::string& content, const std::vector<SE2>& poses) {
    input_ = directory_.Write("input.clf", content);
    const auto log = ReadWholeLog(input_);
    EXPECT_EQ(log.observations.size(), poses.size());
    std::vector<CorrectedScan> scans;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      scans.push_back({poses[i], log.observations.at(i).scan.T_robot_laser});
    }
    return WriteCorrectedLog(input_, Output(), scans);
  }

  std::string Output() const { return directory_.File("corrected.clf"); }

  test_support::TemporaryDirectory directory_;
  std::string input_;
};

TEST_F(CorrectedLogTest, ReplacesTheLasersPoseAndNothingElse) {
  const auto statistics = Correct(
      "# comment \t with blanks\n"
      "PARAM robot_frontlaser_offset 0.5 nohost 0\n"
      "\n"
      "FLASER  2 1.07 81.83 0 0 0 0 0 0 976052857.767368 nohost 0.1\n"
      "ODOM 1 2 3 0 0 0 1 nohost 1\n"
      "FLASER 2 1.08\t81.83 9 9 9   1 2 3 5 other host and more\n"
      "SYNC x 1 nohost 1\n",
      {SE2(10.0, 20.0, 0.0), SE2(30.0, 40.0, 0.0)});
  EXPECT_EQ(ReadFile(Output()),
            "# comment \t with blanks\n"
            "PARAM robot_frontlaser_offset 0.5 nohost 0\n"
            "\n"
            "FLASER  2 1.07 81.83 10.500000 20.000000 0.000000 0 0 0 976052857.767368 nohost 0.1\n"
            "ODOM 1 2 3 0 0 0 1 nohost 1\n"
            "FLASER 2 1.08\t81.83 30.500000 40.000000 0.000000   1 2 3 5 other host and more\n"
            "SYNC x 1 nohost 1\n");
  EXPECT_EQ(statistics.lines, 7);
  EXPECT_EQ(statistics.left_out, 0);
}

TEST_F(CorrectedLogTest, ReadsGzipAndCrLfAndWritesPlainLines) {
  Correct(Gzip("# c\r\nFLASER 1 2 0 0 0 0 0 0 5 nohost 5\r\n"), {SE2(1.0, 2.0, 0.5)});
  EXPECT_EQ(ReadFile(Output()), "# c\nFLASER 1 2 1.000000 2.000000 0.500000 0 0 0 5 nohost 5\n");
}

TEST_F(CorrectedLogTest, LeavesMalformedLinesOut) {
  const auto statistics = Correct(
      "FLASER 1 nan 0 0 0 0 0 0 4 nohost 4\n"
      "FLASER 1 2 0 0 0 0 0 0 5 nohost 5\n"
      "ODOM x\n"
      "FLASER 1 2 0 0 0 0 0 0 6",  // cut in its time stamp
      {SE2(1.0, 2.0, 0.5)});
  EXPECT_EQ(ReadFile(Output()), "FLASER 1 2 1.000000 2.000000 0.500000 0 0 0 5 nohost 5\n");
  EXPECT_EQ(statistics.lines, 1);
  EXPECT_EQ(statistics.left_out, 3);
}

TEST_F(CorrectedLogTest, EndsWhereGzipDataAreCut) {
  std::string content;
  for (int i = 0; i < 2'000; ++i) {
    content += fmt::format("FLASER 1 {} 0 0 0 0 0 0 {} nohost 5\n", 1 + i % 7, i);
  }
  const std::string packed = Gzip(content);
  const std::string half = packed.substr(0, packed.size() / 2);
  const auto log = test_support::ReadWholeLogFrom(half);
  ASSERT_GT(log.observations.size(), 100U);
  const auto statistics = Correct(half, std::vector<SE2>(log.observations.size()));
  EXPECT_EQ(statistics.lines, static_cast<std::int64_t>(log.observations.size()));
  EXPECT_EQ(statistics.left_out, log.statistics.malformed);
}

TEST_F(CorrectedLogTest, OtherLasersTakeTheCorrectionOfTheScanBefore) {
  const std::string rear = "RLASER 1 2 1 0 3 1 0 0 5 nohost 5\n";
  // The robot's odometry (1, 0, 0) is corrected to (5, 5, pi/2).
  Correct(
      rear + "FLASER 1 2 1 0 0 1 0 0 5 nohost 5\n" + "RLASER 1 2 1.5 0 0.5 1.5 0 0 5 nohost 5\n",
      {SE2(), SE2(5.0, 5.0, std::numbers::pi / 2.0)});
  const std::string text = ReadFile(Output());
  EXPECT_THAT(text, HasSubstr("\nRLASER 1 2 5.000000 5.500000 2.070796 1.5 0 0 5 nohost 5\n"));
}

TEST_F(CorrectedLogTest, RawScansBecomeRobotLaserMessages) {
  Correct(
      "PARAM robot_frontlaser_offset 0.5 nohost 0\n"
      "ODOM 1 2 0.25 0 0 0 1 nohost 1\n"
      "RAWLASER1 0 -1.5 3 1.5 50 0.01 0 3 4 5 6 2 77 88 1.5 nohost 1.5\n",
      {SE2(10.0, 20.0, 0.0)});
  const std::string text = ReadFile(Output());
  EXPECT_THAT(text, HasSubstr("\nROBOTLASER1 0 -1.5"));
  EXPECT_THAT(text,
              HasSubstr(" 3 4 5 6 0 10.500000 20.000000 0.000000 1.000000 2.000000 0.250000 "));
  const auto log = ReadWholeLog(Output());
  ASSERT_EQ(log.observations.size(), 1U);
  EXPECT_EQ(log.observations[0].timestamp, 1.5);
  EXPECT_THAT(log.observations[0].scan.ranges, ElementsAre(4.0F, 5.0F, 6.0F));
  EXPECT_EQ(log.observations[0].T_odom_robot.coordinates(), Eigen::Vector3d(1.0, 2.0, 0.25));
}

TEST_F(CorrectedLogTest, StatesAMountThatOnlyThePosesTold) {
  std::string content = "# first\n";
  std::vector<SE2> corrected;
  const SE2 mount(0.3, 0.1, 0.2);
  for (int i = 0; i < 30; ++i) {
    const SE2 robot(0.05 * i, 0.0, 0.05 * i);
    const SE2 laser = robot * mount;
    content +=
        fmt::format("FLASER 1 2 {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {} nohost 5\n", laser.x(),
                    laser.y(), laser.theta(), robot.x(), robot.y(), robot.theta(), i);
    corrected.push_back(SE2(1.0, 2.0, 0.3) * robot);
  }
  Correct(content, corrected);
  const auto log = ReadWholeLog(Output());
  ASSERT_EQ(log.observations.size(), 30U);
  for (const Observation& observation : log.observations) {
    EXPECT_LT(observation.scan.T_robot_laser.Boxminus(mount).norm(), 2e-6);
  }
}

TEST_F(CorrectedLogTest, ReadsBackWithTheSameScansOdometryAndTimes) {
  std::string content = "PARAM robot_frontlaser_offset 0.25 nohost 0\n";
  std::vector<SE2> corrected;
  for (int i = 0; i < 50; ++i) {
    content += fmt::format("FLASER 3 {} {} {} 0 0 0 {:.6f} {:.6f} {:.6f} {:.6f} nohost {}\n",
                           0.01 * i, 1.07 + i, 81.83, 0.1 * i, std::sin(0.1 * i), 0.07 * i,
                           976052857.767368 - 0.3 * i, i);
    corrected.emplace_back(0.09 * i, std::sin(0.1 * i), 0.068 * i);
  }
  Correct(content, corrected);
  const auto before = ReadWholeLog(input_);
  const auto after = ReadWholeLog(Output());
  ASSERT_EQ(after.observations.size(), before.observations.size());
  for (std::size_t i = 0; i < corrected.size(); ++i) {
    EXPECT_EQ(after.observations[i].scan.ranges, before.observations[i].scan.ranges);
    EXPECT_EQ(after.observations[i].timestamp, before.observations[i].timestamp);
    EXPECT_EQ(after.observations[i].T_odom_robot.coordinates(),
              before.observations[i].T_odom_robot.coordinates());
    EXPECT_EQ(after.observations[i].scan.T_robot_laser.x(), 0.25);
  }
  EXPECT_EQ(after.statistics.malformed, 0);
}

TEST_F(CorrectedLogTest, RefusesAnInputWithAnotherNumberOfScans) {
  const std::string line = "FLASER 1 2 0 0 0 0 0 0 5 nohost 5\n";
  const std::string input = directory_.Write("input.clf", line + line);
  for (const std::size_t count : {std::size_t{1}, std::size_t{3}}) {
    const std::vector<CorrectedScan> scans(count);
    EXPECT_THAT([&] { WriteCorrectedLog(input, Output(), scans); },
                ThrowsMessage<Error>(HasSubstr(fmt::format("the {} scans", count))));
  }
  EXPECT_THAT(directory_.Names(), ElementsAre("input.clf"));
}

TEST_F(CorrectedLogTest, SaysWhenTheDiskIsFull) {
  const std::string input = directory_.Write("input.clf", "FLASER 1 2 0 0 0 0 0 0 5 nohost 5\n");
  const std::vector<CorrectedScan> scans(1);
  EXPECT_THAT([&] { WriteCorrectedLog(input, "/dev/full", scans); },
              ThrowsMessage<Error>(HasSubstr("No space left on device")));
}

}  // namespace
}  // namespace loopgrid
