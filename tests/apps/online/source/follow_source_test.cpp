#include "apps/online/source/follow_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "backend/base/error.h"
#include "backend/base/gzip.h"
#include "tests/apps/online/running_source.h"
#include "tests/support/portable_random.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

namespace fs = std::filesystem;
using test_support::PortableRandom;
using test_support::RunningSource;
using test_support::TemporaryDirectory;
using test_support::WaitUntil;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

class FollowSourceTest : public ::testing::Test {
 protected:
  void Append(const std::string& bytes) const {
    std::ofstream(path_, std::ios::app | std::ios::binary) << bytes;
  }

  TemporaryDirectory folder_;
  std::string path_ = folder_.File("today.clf");
};

TEST_F(FollowSourceTest, ReadsWhatIsThereAndWhatIsAddedOnceItsLineIsComplete) {
  Append("one\ntw");
  FollowSource source(path_);
  EXPECT_EQ(source.name(), path_);
  RunningSource running(&source);
  EXPECT_THAT(running.WaitForLines(1), ElementsAre("one"));
  Append("o\nthree\nfou");
  EXPECT_THAT(running.WaitForLines(3), ElementsAre("one", "two", "three"));
  running.Stop();
  EXPECT_THAT(running.lines(), ElementsAre("one", "two", "three", "fou~"));
  EXPECT_THAT(running.problem(), IsEmpty());
}

TEST_F(FollowSourceTest, WaitsForAFileThatIsNotThereYet) {
  FollowSource source(path_);
  RunningSource running(&source);
  Append("one\n");
  EXPECT_THAT(running.WaitForLines(1), ElementsAre("one"));
  EXPECT_EQ(source.counters().rotations, 0);
}

TEST_F(FollowSourceTest, StopsThoughTheFileNeverComes) {
  FollowSource source(path_);
  RunningSource running(&source);
  running.Stop();
  EXPECT_THAT(running.lines(), IsEmpty());
}

TEST_F(FollowSourceTest, AfterARotationReadsTheOldFileToItsEndAndThenTheNewOne) {
  Append("old 1\n");
  FollowSource source(path_);
  RunningSource running(&source);
  running.WaitForLines(1);
  std::ofstream old_one(path_, std::ios::app);
  fs::rename(path_, path_ + ".1");
  Append("");  // an empty new file: its writer may still be writing to the old one
  old_one << "old 2\nold 3" << std::flush;
  running.WaitForLines(2);
  Append("new 1\nnew");
  EXPECT_THAT(running.WaitForLines(4), ElementsAre("old 1", "old 2", "old 3~", "new 1"));
  Append(" 2\n");
  EXPECT_EQ(running.WaitForLines(5).back(), "new 2");
  EXPECT_EQ(source.counters().rotations, 1);
  EXPECT_EQ(source.counters().truncations, 0);
}

TEST_F(FollowSourceTest, FollowsANameThatIsRemovedAndComesBack) {
  Append("old\n");
  FollowSource source(path_);
  RunningSource running(&source);
  running.WaitForLines(1);
  fs::remove(path_);
  Append("new\n");
  EXPECT_THAT(running.WaitForLines(2), ElementsAre("old", "new"));
  EXPECT_EQ(source.counters().rotations, 1);
}

TEST_F(FollowSourceTest, AFileThatShrinksIsReadFromItsBeginningAgain) {
  Append("first line\nsecond");
  FollowSource source(path_);
  RunningSource running(&source);
  running.WaitForLines(1);
  fs::resize_file(path_, 0);
  ASSERT_TRUE(WaitUntil([&] { return source.counters().truncations == 1; }));
  Append("a\n");
  EXPECT_THAT(running.WaitForLines(3), ElementsAre("first line", "second~", "a"));
  EXPECT_EQ(source.counters().rotations, 0);
}

TEST_F(FollowSourceTest, FollowsThroughASymbolicLink) {
  const std::string target = folder_.Write("real.clf", "one\n");
  fs::create_symlink(target, path_);
  FollowSource source(path_);
  RunningSource running(&source);
  running.WaitForLines(1);
  std::ofstream(target, std::ios::app) << "two\n";
  EXPECT_THAT(running.WaitForLines(2), ElementsAre("one", "two"));
}

TEST_F(FollowSourceTest, NoLineIsLostOrRepeatedHoweverItIsWrittenAndRotated) {
  PortableRandom random(7);
  Append("");
  FollowSource source(path_);
  RunningSource running(&source);
  std::vector<std::string> expected;
  for (int i = 0; i < 300; ++i) {
    const std::string line =
        std::to_string(i) + std::string(static_cast<std::size_t>(i % 41 * 30), '.');
    expected.push_back(line);
    const auto cut = static_cast<std::size_t>(random.Uniform(0, static_cast<double>(line.size())));
    Append(line.substr(0, cut));
    Append(line.substr(cut) + "\n");
    if (i % 30 == 29) {
      // Two rotations between two checks would not be noticed.
      ASSERT_TRUE(WaitUntil([&] { return source.counters().rotations == i / 30; }));
      fs::rename(path_, path_ + "." + std::to_string(i));
    }
  }
  EXPECT_EQ(running.WaitForLines(expected.size()), expected);
}

TEST_F(FollowSourceTest, RefusesWhatCannotBeFollowed) {
  const auto opening = [](const std::string& path) { return [=] { FollowSource source(path); }; };
  EXPECT_THAT(opening(folder_.File("none/today.clf")),
              ThrowsMessage<Error>(HasSubstr("today.clf: there is no such folder")));
  EXPECT_THAT(opening(folder_.File("")), ThrowsMessage<Error>(HasSubstr("only a regular file")));
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  EXPECT_THAT(opening(path_), ThrowsMessage<Error>(HasSubstr("only a regular file")));
}

TEST_F(FollowSourceTest, RefusesAFileThatBeginsAsGzip) {
  Append(Gzip("FLASER"));
  FollowSource source(path_);
  RunningSource running(&source);
  running.WaitForEnd();
  EXPECT_THAT(running.problem(), StartsWith(path_ + ": is gzipped"));
}

TEST_F(FollowSourceTest, EndsWhenTheMapperClosesAFullQueue) {
  Append("one\ntwo\nthree\n");
  FollowSource source(path_);
  LineQueue queue(10);
  std::thread reader([&] { source.Run(&queue); });
  ASSERT_TRUE(WaitUntil([&] { return queue.counters().waits == 1; }));
  queue.Close();
  reader.join();
}

}  // namespace
}  // namespace loopgrid
