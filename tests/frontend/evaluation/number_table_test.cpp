#include "frontend/evaluation/number_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "backend/base/line_reader.h"
#include "tests/support/memory_file.h"

namespace loopgrid {
namespace {

using test_support::MemoryFile;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(NumberTable, PassesOverCommentsAndBlankLines) {
  const MemoryFile file(
      "# comment\n\n \t\n1 2 3 4 5 6 7 8\n  # indented\n3\t-4.5e1 0 0 0 0 0 .5 \r\n5 6 0 0 0 0 0 "
      "+1");
  const NumberTable table = ReadNumberTable(file.path());
  EXPECT_EQ(table.path, file.path());
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(table.rows[0].numbers, (std::array<double, 8>{1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(table.rows[1].numbers, (std::array<double, 8>{3, -45, 0, 0, 0, 0, 0, 0.5}));
  EXPECT_EQ(table.rows[2].numbers[7], 1.0);
  EXPECT_EQ(table.rows[0].line_number, 4);
  EXPECT_EQ(table.rows[1].line_number, 6);
  EXPECT_EQ(table.rows[2].line_number, 7);
}

TEST(NumberTable, ErrorsNameTheLineOfTheRow) {
  const MemoryFile file("# comment\n1 2 3 4 5 6 7 8\n");
  const NumberTable table = ReadNumberTable(file.path());
  const Error error = table.ErrorAt(table.rows.at(0), "is odd");
  EXPECT_EQ(error.what(), file.path() + ":2: is odd");
  EXPECT_EQ(error.code(), ErrorCode::kInput);
}

TEST(NumberTable, RefusesAnyOtherLineWithItsNumber) {
  const struct {
    const char* line;
    const char* problem;
  } cases[] = {
      {"1", ":2: expected 8 numbers, found 1"},
      {"1 2 3 4 5 6 7", ":2: expected 8 numbers, found 7"},
      {"1 2 3 4 5 6 7 8 9", ":2: expected 8 numbers, found more"},
      {"1 2 3 4 5 6 7 8 # comment", ":2: expected 8 numbers, found more"},
      {"1 x", ":2: field 2 is not a finite number"},
      {"nan 2", ":2: field 1 is not a finite number"},
      {"1 inf", ":2: field 2 is not a finite number"},
      {"1,5 2", ":2: field 1 is not a finite number"},
      {"hello", ":2: field 1 is not a finite number"},
  };
  for (const auto& [line, problem] : cases) {
    const MemoryFile file(std::string("# first\n") + line + "\n");
    EXPECT_THAT([&] { ReadNumberTable(file.path()); }, ThrowsMessage<Error>(file.path() + problem));
  }
}

TEST(NumberTable, RefusesALineTooLong) {
  std::string line(LineReader::kMaxLineLength + 10, '1');
  line += " 2\n";
  const MemoryFile file(line);
  EXPECT_THAT([&] { ReadNumberTable(file.path()); },
              ThrowsMessage<Error>(HasSubstr(":1: the line is too long")));
}

}  // namespace
}  // namespace loopgrid
