// The decoder alone: lines one by one, line numbers, the end. The meaning of lines is tested
// through CarmenReader, which reads lines and passes them to a decoder.

#include "frontend/log/carmen/carmen_decoder.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "backend/base/error.h"
#include "tests/frontend/log/log_testing.h"
#include "tests/support/portable_random.h"

namespace loopgrid {
namespace {

using test_support::MemoryFile;
using test_support::PortableRandom;
using test_support::ReadWholeLog;
using test_support::WholeLog;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::StrEq;
using ::testing::ThrowsMessage;

/// A robot that drives and turns, with a mount that has to be found from its poses, and lines of
/// all kinds.
std::vector<std::string> SomeLines(int scans) {
  const SE2 mount(0.3, 0.05, -0.1);
  std::vector<std::string> lines = {"# message formats", "", "SYNC tag 0.1 nohost 0.1"};
  for (int i = 0; i < scans; ++i) {
    const SE2 robot(0.05 * i, 0.01 * i, 0.04 * i);
    const SE2 laser = robot * mount;
    lines.push_back(
        fmt::format("ODOM {} {} {} 0 0 0 {} nohost {}", robot.x(), robot.y(), robot.theta(), i, i));
    lines.push_back(fmt::format("FLASER 2 1.5 {} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {} h {}",
                                i % 7, laser.x(), laser.y(), laser.theta(), robot.x(), robot.y(),
                                robot.theta(), i, i));
    if (i % 5 == 3) lines.push_back("FLASER 3 1 2");
    if (i % 9 == 4) lines.push_back("RLASER 1 2 0 0 0 0 0 0 5 nohost 7");
  }
  return lines;
}

void ExpectSame(const WholeLog& a, const WholeLog& b) {
  ASSERT_EQ(a.observations.size(), b.observations.size());
  for (std::size_t i = 0; i < a.observations.size(); ++i) {
    const Observation& x = a.observations[i];
    const Observation& y = b.observations[i];
    EXPECT_EQ(x.timestamp, y.timestamp);
    EXPECT_EQ(x.T_odom_robot.coordinates(), y.T_odom_robot.coordinates());
    EXPECT_EQ(x.scan.T_robot_laser.coordinates(), y.scan.T_robot_laser.coordinates());
    EXPECT_EQ(x.scan.ranges, y.scan.ranges);
  }
  EXPECT_EQ(a.statistics.lines, b.statistics.lines);
  EXPECT_EQ(a.statistics.scans, b.statistics.scans);
  EXPECT_EQ(a.statistics.odometry, b.statistics.odometry);
  EXPECT_EQ(a.statistics.ignored, b.statistics.ignored);
  EXPECT_EQ(a.statistics.malformed, b.statistics.malformed);
  EXPECT_EQ(a.statistics.first_problems, b.statistics.first_problems);
}

TEST(CarmenDecoder, GivesWhatTheReaderGivesHoweverTheLinesArePortioned) {
  const std::vector<std::string> lines = SomeLines(60);
  std::string content;
  for (const std::string& line : lines) content += line + "\n";
  const MemoryFile file(content);
  const WholeLog expected = ReadWholeLog(file.path());
  ASSERT_EQ(expected.observations.size(), 60U);
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    PortableRandom random(seed);
    CarmenDecoder decoder(file.path());
    WholeLog log;
    Observation observation;
    for (const std::string& line : lines) {
      decoder.AddLine(line);
      for (auto n = static_cast<int>(random.Uniform(0, 4)); n > 0; --n) {
        if (decoder.Next(&observation)) log.observations.push_back(observation);
      }
    }
    decoder.Finish();
    while (decoder.Next(&observation)) log.observations.push_back(observation);
    log.statistics = decoder.statistics();
    ExpectSame(log, expected);
  }
}

TEST(CarmenDecoder, NamesTheLineOfEachObservation) {
  const std::vector<std::string> lines = SomeLines(60);
  CarmenDecoder decoder("log");
  std::vector<std::int64_t> numbers;
  std::vector<std::int64_t> expected;
  bool held_back = false;
  Observation observation;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].starts_with("FLASER 2")) expected.push_back(static_cast<std::int64_t>(i) + 1);
    decoder.AddLine(lines[i]);
    EXPECT_EQ(decoder.statistics().lines, static_cast<std::int64_t>(i) + 1);
    while (decoder.Next(&observation)) {
      numbers.push_back(decoder.observation_line());
      held_back |= decoder.observation_line() < decoder.statistics().lines;
    }
  }
  EXPECT_EQ(numbers, expected);
  EXPECT_TRUE(held_back);
}

TEST(CarmenDecoder, HoldsScansBackUntilTheMountIsKnownOrTheLogIsOver) {
  CarmenDecoder decoder("log");
  Observation observation;
  decoder.AddLine("FLASER 1 5 1.3 0 0 1 0 0 7 nohost 7");
  EXPECT_FALSE(decoder.Next(&observation));
  EXPECT_EQ(decoder.statistics().scans, 0);
  decoder.Finish();
  ASSERT_TRUE(decoder.Next(&observation));
  EXPECT_NEAR(observation.scan.T_robot_laser.x(), 0.3, 1e-12);
  EXPECT_FALSE(decoder.Next(&observation));
  EXPECT_EQ(decoder.statistics().scans, 1);
}

TEST(CarmenDecoder, GivesAScanAtOnceWhereTheMountIsStated) {
  CarmenDecoder decoder("log");
  Observation observation;
  decoder.AddLine("PARAM robot_frontlaser_offset 0.25 nohost 0");
  EXPECT_FALSE(decoder.Next(&observation));
  decoder.AddLine("FLASER 1 5 1.3 0 0 1 0 0 7 nohost 7");
  EXPECT_TRUE(decoder.Next(&observation));
  EXPECT_EQ(decoder.observation_line(), 2);
}

TEST(CarmenDecoder, CountsLinesThatAreTooLongOrCutShort) {
  CarmenDecoder decoder("log");
  Observation observation;
  decoder.AddLine("", true, true);
  decoder.AddLine("FLASER 1 5 0 0 0 0 0 0 7", false);  // may have been 77
  decoder.BreakOff("log: is gone");
  decoder.Finish();
  EXPECT_FALSE(decoder.Next(&observation));
  EXPECT_EQ(decoder.statistics().malformed, 3);
  ASSERT_EQ(decoder.statistics().first_problems.size(), 3U);
  EXPECT_EQ(decoder.statistics().first_problems[0], "log:1: the line is too long");
  EXPECT_EQ(decoder.statistics().first_problems[1].find("log:2: "), 0U);
  EXPECT_EQ(decoder.statistics().first_problems[2], "log: is gone");
}

TEST(CarmenDecoder, MarksTheFirstScanOfASession) {
  CarmenDecoder decoder("log");
  std::vector<bool> first;
  const auto add = [&](const char* line) {
    decoder.AddLine(line);
    Observation observation;
    while (decoder.Next(&observation)) first.push_back(observation.new_session);
  };
  add("PARAM robot_frontlaser_offset 0.25 nohost 0");
  add("FLASER 1 5 1.3 0 0 1 0 0 7 nohost 7");
  add("# loopgrid new-session");
  add("ODOM 1 2 0.5 0 0 0 9 nohost 9");
  add("FLASER 1 5 1.3 0 0 1 0 0 7 nohost 7");
  add("FLASER 1 5 1.3 0 0 1 0 0 7 nohost 7");
  EXPECT_THAT(first, ElementsAre(false, true, false));
}

TEST(CarmenDecoder, GivesOutTheScansOfASessionBeforeTheNextBegins) {
  CarmenDecoder decoder("log");
  Observation observation;
  decoder.AddLine("FLASER 1 5 1.3 0 0 1 0 0 7 nohost 7");
  EXPECT_FALSE(decoder.Next(&observation));
  EXPECT_TRUE(decoder.holds_scans());
  decoder.AddLine("# loopgrid new-session");
  EXPECT_TRUE(decoder.Next(&observation));
  EXPECT_FALSE(decoder.holds_scans());
}

TEST(CarmenDecoder, StrictModeRefusesEachOfThem) {
  LogReaderOptions options;
  options.strict = true;
  CarmenDecoder decoder("log", options);
  decoder.AddLine("# fine");
  EXPECT_THAT([&] { decoder.AddLine("", true, true); },
              ThrowsMessage<Error>(StrEq("log:2: the line is too long")));
  EXPECT_THAT([&] { decoder.BreakOff("log: is gone"); },
              ThrowsMessage<Error>(StrEq("log: is gone")));
  EXPECT_THAT(decoder.statistics().first_problems, IsEmpty());
}

}  // namespace
}  // namespace loopgrid
