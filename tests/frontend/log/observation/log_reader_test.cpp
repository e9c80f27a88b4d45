#include "frontend/log/observation/log_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

using ::testing::ElementsAre;
using ::testing::ThrowsMessage;

TEST(CountMalformed, KeepsTheFirstFewProblems) {
  LogReaderOptions options;
  options.max_reported_problems = 2;
  LogStatistics statistics;
  for (const char* problem : {"a:1: x", "a:2: x", "a:3: x"}) {
    CountMalformed(problem, options, &statistics);
  }
  EXPECT_EQ(statistics.malformed, 3);
  EXPECT_THAT(statistics.first_problems, ElementsAre("a:1: x", "a:2: x"));
}

TEST(CountMalformed, ThrowsInStrictMode) {
  LogReaderOptions options;
  options.strict = true;
  LogStatistics statistics;
  EXPECT_THAT([&] { CountMalformed("a:1: x", options, &statistics); },
              ThrowsMessage<Error>("a:1: x"));
}

}  // namespace
}  // namespace loopgrid
