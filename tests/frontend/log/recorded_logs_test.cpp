// The readers on real recordings, if these are available.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "frontend/evaluation/relations_file.h"
#include "frontend/evaluation/tum_file.h"
#include "tests/frontend/log/log_testing.h"
#include "tests/support/recordings.h"

namespace loopgrid {
namespace {

using test_support::ReadWholeLog;
using test_support::WholeLog;

struct Expected {
  const char* name;
  std::size_t scans;
  std::size_t beams;
};

class RecordedLog : public ::testing::TestWithParam<Expected> {};

TEST_P(RecordedLog, HasItsScansAndNoMalformedLine) {
  const Expected& expected = GetParam();
  LOOPGRID_REQUIRE_RECORDING(path, std::string("logs/") + expected.name);
  const WholeLog log = ReadWholeLog(path);
  EXPECT_EQ(log.observations.size(), expected.scans);
  EXPECT_EQ(log.statistics.malformed, 0);
  for (const Observation& observation : log.observations) {
    ASSERT_EQ(observation.scan.ranges.size(), expected.beams);
    ASSERT_NEAR(observation.scan.first_angle, -std::numbers::pi / 2.0, 1e-6);
    ASSERT_EQ(observation.scan.T_robot_laser.coordinates(), Eigen::Vector3d::Zero());
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, RecordedLog,
    ::testing::Values(Expected{"intel.clf", 8946, 180}, Expected{"killian.clf", 3873, 180},
                      Expected{"aces.clf", 440, 180}, Expected{"fhw.clf", 488, 180},
                      Expected{"seattle.clf", 241, 361}, Expected{"acapulco.clf", 861, 181},
                      Expected{"intel-every5.rawlog", 2726, 180}),
    [](const auto& test) {
      std::string name = test.param.name;
      std::replace_if(
          name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
      return name;
    });

TEST(RecordedLogs, TheIntelRawlogIsTheSameRunAsTheLog) {
  LOOPGRID_REQUIRE_RECORDING(log_path, "logs/intel.clf");
  LOOPGRID_REQUIRE_RECORDING(rawlog_path, "logs/intel-every5.rawlog");
  const WholeLog log = ReadWholeLog(log_path);
  const WholeLog rawlog = ReadWholeLog(rawlog_path);
  // The rawlog has every 5th scan of the full run, and the log has two thirds of its scans. So most
  // of the rawlog's scans must be in the log, in the same order and with the same returns.
  const auto same = [](const Observation& raw, const Observation& full) {
    for (std::size_t i = 0; i < raw.scan.ranges.size(); ++i) {
      const bool no_return = raw.scan.ranges[i] >= raw.scan.max_range;
      if (!no_return && std::abs(raw.scan.ranges[i] - full.scan.ranges[i]) > 1e-4F) return false;
    }
    return true;
  };
  std::size_t found = 0;
  auto next = log.observations.begin();
  for (const Observation& raw : rawlog.observations) {
    const auto limit = std::min<std::ptrdiff_t>(200, log.observations.end() - next);
    const auto match =
        std::find_if(next, next + limit, [&](const Observation& full) { return same(raw, full); });
    if (match == next + limit) continue;
    ++found;
    next = match + 1;
  }
  EXPECT_GT(found, rawlog.observations.size() / 2);
}

TEST(RecordedLogs, RelationsAndReferencesAreWellFormed) {
  LOOPGRID_REQUIRE_RECORDING(exact, "logs/intel-exact.relations");
  LOOPGRID_REQUIRE_RECORDING(all, "logs/intel.relations");
  LOOPGRID_REQUIRE_RECORDING(reference, "logs/killian.reference.tum");
  EXPECT_EQ(ReadRelationsFile(exact).size(), 1495U);
  EXPECT_EQ(ReadRelationsFile(all).size(), 2984U);
  EXPECT_EQ(ReadTumFile(reference).size(), 3873U);
}

}  // namespace
}  // namespace loopgrid
