#include "frontend/log/open_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "backend/base/error.h"
#include "backend/base/gzip.h"
#include "tests/frontend/log/log_testing.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::MemoryFile;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(OpenLog, RefusesAMissingFileAndADirectory) {
  const test_support::TemporaryDirectory directory;
  EXPECT_THAT([&] { OpenLog(directory.File("missing.clf")); },
              ThrowsMessage<Error>(HasSubstr("missing.clf: cannot open: No such file")));
  const std::string path = directory.path().string();
  EXPECT_THAT([&] { OpenLog(path); }, ThrowsMessage<Error>(path + ": is a directory"));
}

TEST(OpenLog, RefusesAnEmptyFileAlsoIfItIsGzipped) {
  for (const std::string& content : {std::string(), Gzip("")}) {
    const MemoryFile file(content);
    EXPECT_THAT([&] { OpenLog(file.path()); }, ThrowsMessage<Error>(file.path() + ": is empty"));
  }
}

TEST(OpenLog, RefusesOtherBinaryFiles) {
  const MemoryFile file(std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16));
  EXPECT_THAT([&] { OpenLog(file.path()); },
              ThrowsMessage<Error>(HasSubstr("is neither a CARMEN log nor an MRPT rawlog")));
}

TEST(OpenLog, RefusesGzipDataThatAreCorruptFromTheStart) {
  const MemoryFile file("\x1f\x8b\x08 and then something else");
  EXPECT_THAT([&] { OpenLog(file.path()); }, ThrowsMessage<Error>(HasSubstr("gzip data")));
}

TEST(OpenLog, AFileOfCommentsIsALogWithoutScans) {
  const auto log = test_support::ReadWholeLogFrom("# only\n# comments\n");
  EXPECT_TRUE(log.observations.empty());
  EXPECT_EQ(log.statistics.lines, 2);
  EXPECT_EQ(log.statistics.ignored, 2);
  EXPECT_EQ(log.statistics.malformed, 0);
}

}  // namespace
}  // namespace loopgrid
