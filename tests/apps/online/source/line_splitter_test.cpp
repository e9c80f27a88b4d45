#include "apps/online/source/line_splitter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/apps/online/running_source.h"
#include "tests/support/memory_file.h"
#include "tests/support/portable_random.h"

namespace loopgrid {
namespace {

using test_support::MemoryFile;
using test_support::PortableRandom;
using test_support::Shown;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::string> Split(const std::vector<std::string_view>& pieces,
                               std::size_t max_line_length = 1000) {
  LineSplitter splitter(max_line_length);
  std::vector<std::string> lines;
  ReceivedLine line;
  for (std::string_view piece : pieces) {
    while (splitter.Next(&piece, &line)) lines.push_back(Shown(line));
    EXPECT_TRUE(piece.empty());
  }
  if (splitter.Finish(&line)) lines.push_back(Shown(line));
  EXPECT_FALSE(splitter.Finish(&line));
  return lines;
}

/// The lines that LineReader reads from a file of the same bytes, as the oracle.
std::vector<std::string> ReadLines(std::string_view content, std::size_t max_line_length) {
  const MemoryFile file(content);
  LineReader reader(InputFile(file.path()), max_line_length);
  std::vector<std::string> lines;
  std::string_view text;
  while (reader.Next(&text)) {
    ReceivedLine line;
    line.text = text;
    line.terminated = reader.terminated();
    line.too_long = reader.too_long();
    lines.push_back(Shown(line));
  }
  return lines;
}

TEST(LineSplitter, PutsLinesTogetherFromPieces) {
  EXPECT_THAT(Split({"a", "b\nc", "", "d\n\ne\n"}), ElementsAre("ab", "cd", "", "e"));
}

TEST(LineSplitter, GivesOutALineAsSoonAsItsEndIsThere) {
  LineSplitter splitter;
  ReceivedLine line;
  std::string_view bytes = "one\ntw";
  EXPECT_TRUE(splitter.Next(&bytes, &line));
  EXPECT_EQ(line.text, "one");
  EXPECT_EQ(bytes, "tw");
  EXPECT_FALSE(splitter.Next(&bytes, &line));
}

TEST(LineSplitter, MarksALastLineWithoutItsEnd) {
  EXPECT_THAT(Split({"a\nb"}), ElementsAre("a", "b~"));
  EXPECT_THAT(Split({"a\n"}), ElementsAre("a"));
  EXPECT_THAT(Split({}), IsEmpty());
}

TEST(LineSplitter, TakesOffCrLfEvenIfItComesInTwoPieces) {
  EXPECT_THAT(Split({"a\r", "\nb\r\n\r\nc\rd\n"}), ElementsAre("a", "b", "", "c\rd"));
}

TEST(LineSplitter, TakesOffAByteOrderMarkAtTheStartOfEachStream) {
  EXPECT_THAT(Split({"\xEF", "\xBB", "\xBF", "a\n\xEF\xBB\xBFz\n"}),
              ElementsAre("a", "\xEF\xBB\xBFz"));
  LineSplitter splitter;
  ReceivedLine line;
  for (int stream = 0; stream < 2; ++stream) {
    std::string_view bytes = "\xEF\xBB\xBFx";
    EXPECT_FALSE(splitter.Next(&bytes, &line));
    ASSERT_TRUE(splitter.Finish(&line));
    EXPECT_EQ(line.text, "x");
  }
}

TEST(LineSplitter, PassesOverALineThatIsTooLong) {
  const std::string longest(10, 'x');
  EXPECT_THAT(
      Split({longest, "\n", longest, "\r\n", longest, "y\n", longest, longest, "\nz\n"}, 10),
      ElementsAre(longest, longest, "(too long)", "(too long)", "z"));
  EXPECT_THAT(Split({longest, "y"}, 10), ElementsAre("(too long)~"));
}

TEST(LineSplitter, FindsTheLinesThatLineReaderFindsHoweverTheBytesAreChopped) {
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    PortableRandom random(seed);
    const std::string_view alphabet = "ab\n\r\xEF\xBB\xBF";
    std::string content = seed % 3 == 0 ? "\xEF\xBB\xBF" : "";
    for (auto size = random.Uniform(0, 120); size > 0; --size) {
      content += alphabet[static_cast<std::size_t>(random.Uniform(0, 7))];
    }
    std::vector<std::string_view> pieces;
    for (std::string_view rest = content; !rest.empty();) {
      pieces.push_back(rest.substr(0, static_cast<std::size_t>(random.Uniform(0, 9))));
      rest.remove_prefix(pieces.back().size());
    }
    EXPECT_EQ(Split(pieces, 5), ReadLines(content, 5));
    EXPECT_EQ(Split(pieces, 30), ReadLines(content, 30));
  }
}

}  // namespace
}  // namespace loopgrid
