#include "backend/base/line_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "backend/base/gzip.h"
#include "tests/support/effort.h"
#include "tests/support/memory_file.h"

namespace loopgrid {
namespace {

using test_support::MemoryFile;
using ::testing::ElementsAre;

struct Line {
  std::string text;
  bool too_long = false;
  bool terminated = true;

  bool operator==(const Line&) const = default;
};

void PrintTo(const Line& line, std::ostream* stream) {
  *stream << '"' << line.text.substr(0, 40) << "\" (" << line.text.size() << " bytes"
          << (line.too_long ? ", too long" : "") << (line.terminated ? "" : ", cut") << ')';
}

std::vector<Line> ReadLines(std::string_view content, std::size_t max_line_length) {
  const MemoryFile file(content);
  LineReader reader(InputFile(file.path()), max_line_length);
  std::vector<Line> lines;
  std::string_view line;
  while (reader.Next(&line)) {
    lines.push_back({std::string(line), reader.too_long(), reader.terminated()});
    EXPECT_EQ(reader.line_number(), static_cast<std::int64_t>(lines.size()));
  }
  return lines;
}

std::vector<Line> ReadLines(std::string_view content) {
  return ReadLines(content, LineReader::kMaxLineLength);
}

// What ReadLines must give, the plain way.
std::vector<Line> SplitLines(std::string_view content, std::size_t max_line_length) {
  std::vector<Line> lines;
  while (!content.empty()) {
    const std::size_t end = content.find('\n');
    Line line;
    line.terminated = end != content.npos;
    line.text = content.substr(0, end);
    content.remove_prefix(line.terminated ? end + 1 : content.size());
    if (!line.text.empty() && line.text.back() == '\r') line.text.pop_back();
    line.too_long = line.text.size() > max_line_length;
    if (line.too_long) line.text.clear();
    lines.push_back(line);
  }
  return lines;
}

TEST(LineReader, TakesBothLineEndsAndMarksACutLastLine) {
  EXPECT_THAT(ReadLines("a\nb\r\n\n\r\nc"),
              ElementsAre(Line{"a"}, Line{"b"}, Line{""}, Line{""}, Line{"c", false, false}));
  EXPECT_THAT(ReadLines("a\n"), ElementsAre(Line{"a"}));
  EXPECT_THAT(ReadLines("\n"), ElementsAre(Line{""}));
  EXPECT_THAT(ReadLines(""), ElementsAre());
}

TEST(LineReader, KeepsACarriageReturnWithinALine) {
  EXPECT_THAT(ReadLines("a\rb\r\r\n"), ElementsAre(Line{"a\rb\r"}));
}

TEST(LineReader, KeepsZeroBytes) {
  const std::string content("a\0b\nc\n", 6);
  EXPECT_THAT(ReadLines(content), ElementsAre(Line{std::string("a\0b", 3)}, Line{"c"}));
}

TEST(LineReader, DropsAByteOrderMarkAtTheBeginningOnly) {
  EXPECT_THAT(ReadLines("\xEF\xBB\xBFODOM\n\xEF\xBB\xBFODOM\n"),
              ElementsAre(Line{"ODOM"}, Line{"\xEF\xBB\xBFODOM"}));
}

TEST(LineReader, ReadsGzippedLines) {
  EXPECT_THAT(ReadLines(Gzip("a\r\nb\nc")),
              ElementsAre(Line{"a"}, Line{"b"}, Line{"c", false, false}));
}

TEST(LineReader, ALineOfTheMaximumLengthIsNotTooLong) {
  EXPECT_THAT(ReadLines("1234\n12345\n1234\r\n12345\r\n1234", 4),
              ElementsAre(Line{"1234"}, Line{"", true}, Line{"1234"}, Line{"", true},
                          Line{"1234", false, false}));
}

TEST(LineReader, PassesOverLinesLongerThanItsBuffer) {
  std::string content(3'000'000, 'x');
  content += "\nshort\n";
  content.append(500'000, 'y');
  EXPECT_THAT(ReadLines(content, 1000),
              ElementsAre(Line{"", true}, Line{"short"}, Line{"", true, false}));
}

TEST(LineReader, SplitsRandomTextAsThePlainWayDoes) {
  for (unsigned seed = 0; seed < test_support::Effort(60U, 6U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const std::size_t max_line_length = seed % 3 == 0 ? 20 : 100'000;
    const unsigned rarity = seed % 2 == 0 ? 15 : 30'000;
    std::string content;
    const std::size_t size = random() % 400'000;
    while (content.size() < size) {
      const unsigned roll = static_cast<unsigned>(random()) % rarity;
      content += roll == 0 ? "\n" : roll == 1 ? "\r\n" : roll == 2 ? "\r" : "z";
    }
    const std::vector<Line> expected = SplitLines(content, max_line_length);
    EXPECT_EQ(ReadLines(content, max_line_length), expected);
    EXPECT_EQ(ReadLines(Gzip(content), max_line_length), expected);
  }
}

TEST(LineReader, SaysWhereItIs) {
  const MemoryFile file("one\ntwo\n");
  LineReader reader(file.path());
  std::string_view line;
  ASSERT_TRUE(reader.Next(&line));
  ASSERT_TRUE(reader.Next(&line));
  EXPECT_EQ(reader.Where(), file.path() + ":2: ");
  EXPECT_EQ(reader.ErrorHere("not a number").what(), file.path() + ":2: not a number");
  EXPECT_EQ(reader.ErrorHere("").code(), ErrorCode::kInput);
}

}  // namespace
}  // namespace loopgrid
