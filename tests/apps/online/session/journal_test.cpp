#include "apps/online/session/journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "backend/base/error.h"
#include "backend/base/line_reader.h"
#include "frontend/log/carmen/carmen_decoder.h"
#include "tests/apps/small_log.h"
#include "tests/support/portable_random.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::PortableRandom;
using test_support::ReadFile;
using test_support::TemporaryDirectory;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

ReceivedLine Terminated(const std::string& text) { return {.text = text}; }
ReceivedLine Cut(const std::string& text) { return {.text = text, .terminated = false}; }
ReceivedLine TooLong(bool terminated = true) {
  return {.terminated = terminated, .too_long = true};
}

/// The observations that a decoder makes of lines.
class Decoded {
 public:
  void Add(const ReceivedLine& line) {
    decoder_.AddLine(line.text, line.terminated, line.too_long);
    Observation observation;
    while (decoder_.Next(&observation)) {
      scans_.push_back({static_cast<double>(decoder_.observation_line()), observation.timestamp,
                        observation.T_odom_robot.x(), observation.scan.ranges.front(),
                        observation.scan.T_robot_laser.x()});
    }
  }

  void ExpectSameAs(const Decoded& other) const {
    EXPECT_EQ(scans_, other.scans_);
    const LogStatistics& a = decoder_.statistics();
    const LogStatistics& b = other.decoder_.statistics();
    EXPECT_EQ(a.lines, b.lines);
    EXPECT_EQ(a.odometry, b.odometry);
    EXPECT_EQ(a.ignored, b.ignored);
    EXPECT_EQ(a.malformed, b.malformed);
    EXPECT_EQ(a.first_problems, b.first_problems);
  }

 private:
  CarmenDecoder decoder_{"log"};
  std::vector<std::vector<double>> scans_;
};

Decoded DecodedFrom(const Journal& journal) {
  Decoded decoded;
  journal.Read([&decoded](const ReceivedLine& line) { decoded.Add(line); });
  return decoded;
}

TEST(Journal, HoldsTheLinesThemselves) {
  const TemporaryDirectory folder;
  Journal journal(folder.File("journal.clf"));
  EXPECT_TRUE(journal.empty());
  journal.Append(Terminated("FLASER 1 5"));
  journal.Append(Terminated(""));
  journal.Append(Cut("ODOM 1 2"));
  EXPECT_FALSE(journal.empty());
  EXPECT_TRUE(journal.has_open_end());
  EXPECT_EQ(ReadFile(journal.path()), "FLASER 1 5\n\nODOM 1 2");
}

TEST(Journal, LineThatBrokeOffLosesItsCutFieldWhenAnotherFollows) {
  const TemporaryDirectory folder;
  Journal journal(folder.File("journal.clf"));
  journal.Append(Cut("ODOM 1 2"));
  journal.Append(Cut("FLASER"));
  journal.Append(TooLong(false));
  journal.Append(Terminated("# end"));
  const std::string too_long(LineReader::kMaxLineLength + 1, '#');
  EXPECT_TRUE(ReadFile(journal.path()) == "ODOM 1 \n\n" + too_long + "\n# end\n");
}

TEST(Journal, LastLineWithoutEndIsCompletedByTheLineThatItBegins) {
  const TemporaryDirectory folder;
  folder.Write("journal.clf", "# a\nODOM 1 2");
  Journal journal(folder.File("journal.clf"));
  ASSERT_TRUE(journal.has_open_end());
  EXPECT_FALSE(journal.IsContinuedBy(Terminated("ODOM 1 3")));
  ASSERT_TRUE(journal.IsContinuedBy(Terminated("ODOM 1 23 4")));
  journal.Complete(Terminated("ODOM 1 23 4"));
  EXPECT_FALSE(journal.has_open_end());
  journal.Append(Terminated("b"));
  EXPECT_EQ(ReadFile(journal.path()), "# a\nODOM 1 23 4\nb\n");
}

/// A line that a robot would not send.
ReceivedLine AwkwardLine(PortableRandom* random, const std::vector<std::string>& good) {
  const std::vector<std::string> pieces = {
      "\r",       " ", "\t",           "FLASER 1 5 0 0 0 0 0 0 7 h 7",
      "ODOM 1 2", "#", "\xEF\xBB\xBF", std::string(1, '\0'),
      "x"};
  ReceivedLine line;
  if (random->Uniform() < 0.5) {
    line.text = good[random->Index(good.size())];
    line.text.resize(random->Index(2 * line.text.size()), ' ');
  } else {
    for (std::size_t i = random->Index(4); i > 0; --i) {
      line.text += pieces[random->Index(pieces.size())];
    }
  }
  line.terminated = random->Uniform() < 0.8;
  line.too_long = random->Uniform() < 0.01;
  if (line.too_long) line.text.clear();
  if (line.text.empty() && !line.too_long)
    line.terminated = true;  // otherwise it would not be a line
  return line;
}

TEST(Journal, ReadsBackAsWhatWasReceivedWhateverThatWas) {
  std::vector<std::string> good;
  std::istringstream log(test_support::SmallLog(5));
  for (std::string line; std::getline(log, line);) good.push_back(line);
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    PortableRandom random(seed);
    const TemporaryDirectory folder;
    Journal journal(folder.File("journal.clf"));
    Decoded live;
    for (int i = 0; i < 60; ++i) {
      ReceivedLine line = AwkwardLine(&random, good);
      if (journal.empty()) KeepReadable(&line);
      journal.Append(line);
      live.Add(line);
      if (i % 20 == 19) DecodedFrom(journal).ExpectSameAs(live);
    }
  }
}

TEST(Journal, FirstLineNeverMakesItLookPackedOrBinary) {
  const std::string rawlog(
      "\x94"
      "CObservation2DRangeScan",
      24);
  for (const std::string& first :
       {std::string("\x1f\x8b\x08 x"), std::string("\xEF\xBB\xBF# x"), rawlog}) {
    const TemporaryDirectory folder;
    Journal journal(folder.File("journal.clf"));
    ReceivedLine line = Terminated(first);
    KeepReadable(&line);
    journal.Append(line);
    std::vector<std::string> read;
    journal.Read([&read](const ReceivedLine& l) { read.push_back(l.text); });
    EXPECT_THAT(read, ::testing::ElementsAre("# " + first));
  }
}

/// Limits the size of files while the object exists.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit = {bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_ = {};
};

TEST(Journal, EndsWithAWholeLineWhenTheDiskIsFull) {
  const TemporaryDirectory folder;
  Journal journal(folder.File("journal.clf"));
  journal.Append(Terminated("# first"));
  {
    const FileSizeLimit limit(20);
    EXPECT_THAT([&] { journal.Append(Terminated("# this one is too much")); },
                ThrowsMessage<Error>(HasSubstr("journal.clf: cannot write: File too large")));
  }
  EXPECT_EQ(ReadFile(journal.path()), "# first\n");
  journal.Append(Terminated("# next"));
  EXPECT_EQ(ReadFile(journal.path()), "# first\n# next\n");
}

TEST(Journal, NoticesThatItIsGone) {
  const TemporaryDirectory folder;
  Journal journal(folder.File("journal.clf"));
  journal.Append(Terminated("# first"));
  journal.Sync();
  std::filesystem::remove(journal.path());
  EXPECT_THAT([&] { journal.Sync(); }, ThrowsMessage<Error>(HasSubstr("journal.clf: was removed")));
}

TEST(Journal, ThatCannotBeMadeIsAnOutputError) {
  EXPECT_THAT([] { Journal("/proc/none/journal.clf"); },
              ThrowsMessage<Error>(StartsWith("/proc/none/journal.clf: cannot open: ")));
}

}  // namespace
}  // namespace loopgrid
