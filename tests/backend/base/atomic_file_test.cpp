#include "backend/base/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <random>
#include <string>

#include "backend/base/error.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::ReadFile;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;
using ::testing::UnorderedElementsAre;

class AtomicFileTest : public ::testing::Test {
 protected:
  test_support::TemporaryDirectory directory_;
};

TEST_F(AtomicFileTest, TheFileAppearsWithCommit) {
  const std::string path = directory_.File("map.yaml");
  AtomicFile file(path);
  file.Append("image: ");
  file.Append("map.pgm\n");
  EXPECT_FALSE(std::filesystem::exists(path));
  file.Commit();
  EXPECT_EQ(ReadFile(path), "image: map.pgm\n");
  EXPECT_THAT(directory_.Names(), ElementsAre("map.yaml"));
}

TEST_F(AtomicFileTest, WithoutCommitNothingRemainsAndTheOldFileIsWhole) {
  const std::string path = directory_.Write("old", "old content");
  {
    AtomicFile file(path);
    file.Append(std::string(1'000'000, 'x'));
    EXPECT_EQ(ReadFile(path), "old content");
  }
  EXPECT_EQ(ReadFile(path), "old content");
  EXPECT_THAT(directory_.Names(), ElementsAre("old"));
}

TEST_F(AtomicFileTest, KeepsEveryByteInOrder) {
  std::mt19937 random(11);
  std::string expected;
  AtomicFile file(directory_.File("bytes"));
  while (expected.size() < 500'000) {
    std::string piece(random() % 5'000, '\0');
    for (char& byte : piece) byte = static_cast<char>(random());
    file.Append(piece);
    expected += piece;
  }
  file.Commit();
  EXPECT_EQ(ReadFile(directory_.File("bytes")), expected);
}

TEST_F(AtomicFileTest, HonoursTheUmask) {
  const mode_t old = umask(027);
  WriteFileAtomically(directory_.File("file"), "x");
  umask(old);
  struct stat status = {};
  ASSERT_EQ(stat(directory_.File("file").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0640U);
}

TEST_F(AtomicFileTest, ASymbolicLinkStaysOneAndItsTargetIsReplaced) {
  const std::string target = directory_.Write("target", "old");
  const std::string link = directory_.File("link");
  std::filesystem::create_symlink(target, link);
  WriteFileAtomically(link, "new");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(ReadFile(target), "new");
}

TEST_F(AtomicFileTest, TwoWritersOfOneFileDoNotMix) {
  const std::string path = directory_.File("file");
  AtomicFile first(path);
  AtomicFile second(path);
  first.Append("first");
  second.Append("second");
  second.Commit();
  EXPECT_EQ(ReadFile(path), "second");
  first.Commit();
  EXPECT_EQ(ReadFile(path), "first");
  EXPECT_THAT(directory_.Names(), ElementsAre("file"));
}

TEST_F(AtomicFileTest, RefusesADirectory) {
  const std::string path = directory_.path().string();
  EXPECT_THAT([&] { WriteFileAtomically(path, "x"); },
              ThrowsMessage<Error>(path + ": is a directory"));
}

TEST_F(AtomicFileTest, RefusesAFolderThatIsMissingOrAFile) {
  const std::string missing = directory_.File("missing/file");
  EXPECT_THAT([&] { AtomicFile file(missing); },
              ThrowsMessage<Error>(
                  AllOf(StartsWith(missing + ": "), HasSubstr("No such file or directory"))));
  directory_.Write("plain", "");
  EXPECT_THAT([&] { AtomicFile file(directory_.File("plain/file")); },
              ThrowsMessage<Error>(HasSubstr("Not a directory")));
}

TEST_F(AtomicFileTest, RefusesAFolderThatMayNotBeWritten) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  ASSERT_EQ(chmod(directory_.path().c_str(), 0500), 0);
  EXPECT_THAT([&] { AtomicFile file(directory_.File("file")); },
              ThrowsMessage<Error>(HasSubstr("Permission denied")));
  chmod(directory_.path().c_str(), 0700);
}

TEST_F(AtomicFileTest, ErrorsAreOutputErrors) {
  try {
    AtomicFile file(directory_.File("missing/file"));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kOutput);
  }
}

TEST_F(AtomicFileTest, SaysWhenTheDiskIsFull) {
  // A device is written directly: the small write fails at Commit(), the large one before.
  EXPECT_THAT(
      [] { WriteFileAtomically("/dev/full", "x"); },
      ThrowsMessage<Error>(AllOf(StartsWith("/dev/full: "), HasSubstr("No space left on device"))));
  AtomicFile file("/dev/full");
  EXPECT_THAT([&] { file.Append(std::string(1'000'000, 'x')); },
              ThrowsMessage<Error>(HasSubstr("No space left on device")));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST_F(AtomicFileTest, AWriteThatFailsHalfWayLeavesTheOldFileAndNothingElse) {
  const std::string path = directory_.Write("file", "old content");
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit old_limit = {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  const rlimit limit = {100'000, old_limit.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  EXPECT_THAT([&] { WriteFileAtomically(path, std::string(1'000'000, 'x')); },
              ThrowsMessage<Error>(AllOf(StartsWith(path), HasSubstr("File too large"))));
  setrlimit(RLIMIT_FSIZE, &old_limit);
  EXPECT_EQ(ReadFile(path), "old content");
  EXPECT_THAT(directory_.Names(), ElementsAre("file"));
}

TEST_F(AtomicFileTest, WritesThroughAPipe) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  WriteFileAtomically("/proc/self/fd/" + std::to_string(ends[1]), "hello");
  close(ends[1]);
  std::string got(100, '\0');
  got.resize(static_cast<std::size_t>(read(ends[0], got.data(), got.size())));
  close(ends[0]);
  EXPECT_EQ(got, "hello");
}

TEST_F(AtomicFileTest, RemoveTemporariesRemovesThemAll) {
  AtomicFile first(directory_.File("first"));
  AtomicFile second(directory_.File("second"));
  { AtomicFile gone(directory_.File("gone")); }
  WriteFileAtomically(directory_.File("done"), "x");
  EXPECT_EQ(directory_.Names().size(), 3U);
  AtomicFile::RemoveTemporaries();
  EXPECT_THAT(directory_.Names(), UnorderedElementsAre("done"));
}

}  // namespace
}  // namespace loopgrid
