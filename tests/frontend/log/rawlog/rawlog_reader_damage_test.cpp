// Rawlogs that are cut, damaged, or hold objects of classes that are not known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "backend/base/error.h"
#include "backend/base/gzip.h"
#include "frontend/log/rawlog/rawlog_reader.h"
#include "tests/frontend/log/log_testing.h"
#include "tests/frontend/log/rawlog/rawlog_testing.h"
#include "tests/support/effort.h"

namespace loopgrid {
namespace {

using mrpt::poses::CPose2D;
using test_support::MemoryFile;
using test_support::RawlogBytes;
using test_support::ReadWholeLog;
using test_support::ReadWholeLogFrom;
using test_support::Scan;
using test_support::SmallRawlog;
using test_support::WholeLog;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

TEST(RawlogReaderDamage, ARawlogCutAnywhereGivesTheScansBeforeTheCutAndCountsIt) {
  const std::string whole = SmallRawlog().str();
  std::vector<std::size_t> object_ends;
  RawlogBytes growing;
  for (int i = 0; i < 3; ++i) {
    growing.AddMovement(CPose2D(0.5, 0.0, 0.1));
    object_ends.push_back(growing.str().size());
    growing.AddFrame({Scan({1.0F, 2.0F, 3.0F}, 5.0 + i)});
    object_ends.push_back(growing.str().size());
  }
  ASSERT_EQ(growing.str(), whole);
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  for (std::size_t size = object_ends[0]; size <= whole.size(); ++size) {
    SCOPED_TRACE(size);
    const auto complete = static_cast<std::size_t>(
        std::upper_bound(object_ends.begin(), object_ends.end(), size) - object_ends.begin());
    const bool clean = object_ends[complete - 1] == size;
    const MemoryFile file(whole.substr(0, size));
    const WholeLog log = ReadWholeLog(file.path());
    EXPECT_EQ(log.observations.size(), complete / 2);
    EXPECT_EQ(log.statistics.malformed, clean ? 0 : 1);
    if (!clean) {
      EXPECT_THAT(log.statistics.first_problems,
                  ElementsAre(file.path() + ": ends in the middle of an object"));
    }
  }
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(RawlogReaderDamage, ARawlogCutInItsFirstObjectIsRefused) {
  const std::string whole = SmallRawlog().str();
  const MemoryFile file(whole.substr(0, 40));
  EXPECT_THAT([&] { ReadWholeLog(file.path()); },
              ThrowsMessage<Error>(file.path() + ": ends in the middle of an object"));
}

TEST(RawlogReaderDamage, SurvivesAnyByteBeingWrong) {
  const std::string whole = SmallRawlog().str();
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  const std::size_t step = test_support::Effort(1U, 7U);
  for (std::size_t i = 0; i < 2 * whole.size(); i += step) {
    SCOPED_TRACE(i);
    std::string damaged = whole;
    char& byte = damaged[i / 2];
    byte = static_cast<char>(byte ^ (i % 2 == 0 ? 1 : 4));
    try {
      const WholeLog log = ReadWholeLogFrom(damaged);
      for (const Observation& observation : log.observations) {
        EXPECT_TRUE(observation.T_odom_robot.coordinates().allFinite());
        for (const float range : observation.scan.ranges) EXPECT_TRUE(range >= 0.0F);
      }
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInput);
    }
  }
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(RawlogReaderDamage, CutGzipDataGiveWhatComesBefore) {
  RawlogBytes bytes;
  for (int i = 0; i < 300; ++i) {
    bytes.AddMovement(CPose2D(0.01 * i, 0.0, 0.1))
        .AddFrame({Scan(std::vector<float>(100, 0.1F * static_cast<float>(i)), i)});
  }
  const std::string packed = Gzip(bytes.str());
  EXPECT_THAT(ReadWholeLogFrom(packed).observations, SizeIs(300));
  const MemoryFile file(packed.substr(0, packed.size() / 2));
  const WholeLog log = ReadWholeLog(file.path());
  EXPECT_GT(log.observations.size(), 50U);
  EXPECT_THAT(log.statistics.first_problems,
              ElementsAre(file.path() + ": the gzip data are cut short"));
}

TEST(RawlogReaderDamage, EndsAtAnObjectOfAnUnknownClass) {
  const std::string unknown =
      "\x8d"
      "CUnknownThing"
      "\x01\x88";
  const MemoryFile file(SmallRawlog().str() + unknown + SmallRawlog().str());
  const WholeLog log = ReadWholeLog(file.path());
  EXPECT_THAT(log.observations, SizeIs(3));
  EXPECT_EQ(log.statistics.malformed, 1);
  EXPECT_THAT(log.statistics.first_problems.at(0),
              HasSubstr(": an object of the class CUnknownThing, which is not known"));
  const MemoryFile first(unknown);
  LogReaderOptions quiet;
  quiet.max_reported_problems = 0;
  EXPECT_THAT([&] { ReadWholeLog(first.path(), quiet); },
              ThrowsMessage<Error>(HasSubstr("the class CUnknownThing")));
}

}  // namespace
}  // namespace loopgrid
