#include "apps/replay/raw_line_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "backend/base/error.h"
#include "backend/base/gzip.h"
#include "tests/support/memory_file.h"
#include "tests/support/portable_random.h"

namespace loopgrid {
namespace {

using test_support::MemoryFile;
using test_support::PortableRandom;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

/// The pieces with the numbers of their lines; what is not a whole line has a `~` behind.
std::vector<std::pair<std::int64_t, std::string>> Read(const std::string& content,
                                                       std::size_t longest_piece) {
  const MemoryFile file(content);
  RawLineReader reader(InputFile(file.path()), longest_piece);
  std::vector<std::pair<std::int64_t, std::string>> pieces;
  std::string_view piece;
  while (reader.Next(&piece)) {
    pieces.emplace_back(reader.line_number(), std::string(piece) + (reader.whole() ? "" : "~"));
  }
  return pieces;
}

TEST(RawLineReader, GivesLinesWithTheirEnds) {
  EXPECT_THAT(
      Read("a\r\n\n\xEF\xBB\xBFz\nlast", 100),
      ElementsAre(Pair(1, "a\r\n"), Pair(2, "\n"), Pair(3, "\xEF\xBB\xBFz\n"), Pair(4, "last~")));
  EXPECT_THAT(Read(Gzip("a\nb\n"), 100), ElementsAre(Pair(1, "a\n"), Pair(2, "b\n")));
  EXPECT_THAT(Read("", 100), IsEmpty());
}

TEST(RawLineReader, GivesALongLineInPieces) {
  EXPECT_THAT(Read("12345678\nab\n", 3),
              ElementsAre(Pair(1, "123~"), Pair(1, "456~"), Pair(1, "78\n~"), Pair(2, "ab\n")));
  EXPECT_THAT(Read("123456\nab", 3),
              ElementsAre(Pair(1, "123~"), Pair(1, "456~"), Pair(1, "\n~"), Pair(2, "ab~")));
}

TEST(RawLineReader, ThePiecesAreTheFile) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE(seed);
    PortableRandom random(seed);
    std::string content;
    while (content.size() < 200'000) {
      content += std::string(static_cast<std::size_t>(random.Uniform(0, 9'000)), 'x') + "\n";
    }
    std::string whole;
    std::int64_t lines = 0;
    for (const auto& [number, piece] : Read(content, 8'000)) {
      whole += piece.ends_with('~') ? piece.substr(0, piece.size() - 1) : piece;
      lines = number;
    }
    EXPECT_EQ(whole, content);
    EXPECT_EQ(lines, std::count(content.begin(), content.end(), '\n'));
  }
}

TEST(RawLineReader, GivesWhatComesBeforeABreak) {
  std::string content;
  PortableRandom random(1);
  for (int i = 0; i < 40'000; ++i) content += std::to_string(random.Uniform()) + "\n";
  const std::string packed = Gzip(content);
  const MemoryFile file(packed.substr(0, packed.size() / 2));
  RawLineReader reader{InputFile(file.path())};
  std::string whole;
  std::string_view piece;
  EXPECT_THROW(while (reader.Next(&piece)) whole += piece, Error);
  EXPECT_GT(whole.size(), content.size() / 4);
  EXPECT_EQ(content.substr(0, whole.size()), whole);
}

}  // namespace
}  // namespace loopgrid
