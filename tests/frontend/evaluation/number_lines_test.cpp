#include "frontend/evaluation/number_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "tests/support/memory_file.h"

namespace loopgrid {
namespace {

using test_support::MemoryFile;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(NextNumberLine, PassesOverCommentsAndBlankLines) {
  const MemoryFile file("# comment\n\n \t\n1 2\n  # indented\n3\t-4.5e1 \r\n5 6");
  LineReader lines(file.path());
  std::array<double, 2> numbers{};
  ASSERT_TRUE(NextNumberLine(&lines, numbers));
  EXPECT_THAT(numbers, ElementsAre(1.0, 2.0));
  EXPECT_EQ(lines.line_number(), 4);
  ASSERT_TRUE(NextNumberLine(&lines, numbers));
  EXPECT_THAT(numbers, ElementsAre(3.0, -45.0));
  ASSERT_TRUE(NextNumberLine(&lines, numbers));
  EXPECT_THAT(numbers, ElementsAre(5.0, 6.0));
  EXPECT_FALSE(NextNumberLine(&lines, numbers));
}

TEST(NextNumberLine, RefusesAnyOtherLineWithItsNumber) {
  const struct {
    const char* line;
    const char* problem;
  } cases[] = {
      {"1", ":2: expected 2 numbers, found 1"},
      {"1 2 3", ":2: expected 2 numbers, found more"},
      {"1 2 # comment", ":2: expected 2 numbers, found more"},
      {"1 x", ":2: field 2 is not a finite number"},
      {"nan 2", ":2: field 1 is not a finite number"},
      {"1 inf", ":2: field 2 is not a finite number"},
      {"1,5 2", ":2: field 1 is not a finite number"},
      {"hello", ":2: field 1 is not a finite number"},
  };
  for (const auto& [line, problem] : cases) {
    const MemoryFile file(std::string("# first\n") + line + "\n");
    LineReader lines(file.path());
    std::array<double, 2> numbers{};
    EXPECT_THAT([&] { NextNumberLine(&lines, numbers); },
                ThrowsMessage<Error>(file.path() + problem));
  }
}

TEST(NextNumberLine, RefusesALineTooLong) {
  std::string line(LineReader::kMaxLineLength + 10, '1');
  line += " 2\n";
  const MemoryFile file(line);
  LineReader lines(file.path());
  std::array<double, 2> numbers{};
  EXPECT_THAT([&] { NextNumberLine(&lines, numbers); },
              ThrowsMessage<Error>(HasSubstr(":1: the line is too long")));
}

}  // namespace
}  // namespace loopgrid
