#include "backend/base/input_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <random>
#include <string>
#include <thread>

#include "backend/base/error.h"
#include "backend/base/gzip.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

std::string RandomBytes(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  std::string bytes(size, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random() % 7 == 0 ? random() % 256 : 'x');
  return bytes;
}

std::string ReadAll(InputFile* file, std::size_t step) {
  std::string all;
  std::string piece(step, '\0');
  for (;;) {
    const std::size_t count = file->Read(piece.data(), piece.size());
    if (count == 0) return all;
    all.append(piece, 0, count);
  }
}

class InputFileTest : public ::testing::Test {
 protected:
  test_support::TemporaryDirectory directory_;
};

TEST_F(InputFileTest, GivesPlainBytesAsTheyAre) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{300'000}}) {
    const std::string bytes = RandomBytes(size, 1);
    const std::string path = directory_.Write("plain.gz", bytes);  // the name means nothing
    InputFile file(path);
    EXPECT_EQ(ReadAll(&file, 1000), bytes);
  }
}

TEST_F(InputFileTest, UnpacksGzipWhateverTheName) {
  const std::string bytes = RandomBytes(300'000, 2);
  InputFile file(directory_.Write("log.txt", Gzip(bytes)));
  EXPECT_EQ(ReadAll(&file, 777), bytes);
}

TEST_F(InputFileTest, UnpacksConcatenatedGzipMembers) {
  InputFile file(directory_.Write("two", Gzip("one") + Gzip("two")));
  EXPECT_EQ(ReadAll(&file, 100), "onetwo");
}

TEST_F(InputFileTest, PeekConsumesNothing) {
  const std::string bytes = RandomBytes(5'000, 3);
  InputFile file(directory_.Write("file", bytes));
  EXPECT_EQ(file.Peek(10), bytes.substr(0, 10));
  EXPECT_EQ(file.Peek(4'000), bytes.substr(0, 4'000));
  EXPECT_EQ(file.Peek(3), bytes.substr(0, 3));
  EXPECT_EQ(ReadAll(&file, 64), bytes);
}

TEST_F(InputFileTest, PeekGivesWhatThereIs) {
  InputFile file(directory_.Write("file", "ab"));
  EXPECT_EQ(file.Peek(100), "ab");
  InputFile empty(directory_.Write("empty", ""));
  EXPECT_EQ(empty.Peek(100), "");
}

TEST_F(InputFileTest, ProgressGoesFromZeroToOne) {
  const std::string packed = Gzip(RandomBytes(2'000'000, 4));
  InputFile file(directory_.Write("file.gz", packed));
  double last = file.progress();
  EXPECT_EQ(last, 0.0);
  std::string piece(10'000, '\0');
  while (file.Read(piece.data(), piece.size()) > 0) {
    EXPECT_GE(file.progress(), last);
    last = file.progress();
  }
  EXPECT_EQ(last, 1.0);
}

TEST_F(InputFileTest, ReadsFromAPipeWithoutKnowingItsProgress) {
  const std::string path = directory_.File("pipe");
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(path) << "through the pipe"; });
  InputFile file(path);
  EXPECT_EQ(ReadAll(&file, 4), "through the pipe");
  EXPECT_EQ(file.progress(), 0.0);
  writer.join();
}

TEST_F(InputFileTest, RefusesAMissingFile) {
  const std::string path = directory_.File("missing.clf");
  EXPECT_THAT(
      [&] { InputFile file(path); },
      ThrowsMessage<Error>(AllOf(StartsWith(path + ": "), HasSubstr("No such file or directory"))));
}

TEST_F(InputFileTest, RefusesADirectory) {
  const std::string path = directory_.path().string();
  EXPECT_THAT([&] { InputFile file(path); }, ThrowsMessage<Error>(path + ": is a directory"));
}

TEST_F(InputFileTest, RefusesAFileThatMayNotBeRead) {
  if (geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const std::string path = directory_.Write("secret", "x");
  ASSERT_EQ(chmod(path.c_str(), 0), 0);
  EXPECT_THAT([&] { InputFile file(path); }, ThrowsMessage<Error>(HasSubstr("Permission denied")));
}

TEST_F(InputFileTest, SaysWhenReadingFails) {
  InputFile file("/proc/self/mem");  // opens, but nothing is mapped at its beginning
  char byte = 0;
  EXPECT_THAT([&] { file.Read(&byte, 1); },
              ThrowsMessage<Error>(StartsWith("/proc/self/mem: cannot read: ")));
}

TEST_F(InputFileTest, GivesWhatComesBeforeACutInGzipDataAndThenSaysSo) {
  const std::string bytes = RandomBytes(200'000, 5);
  const std::string packed = Gzip(bytes);
  InputFile file(directory_.Write("cut.gz", packed.substr(0, packed.size() / 2)));
  std::string piece(1'000, '\0');
  std::string all;
  EXPECT_THAT(
      [&] {
        while (const std::size_t count = file.Read(piece.data(), piece.size())) {
          all.append(piece, 0, count);
        }
      },
      ThrowsMessage<Error>(HasSubstr("cut.gz: the gzip data are cut short")));
  EXPECT_GT(all.size(), bytes.size() / 4);
  EXPECT_EQ(all, bytes.substr(0, all.size()));
}

TEST_F(InputFileTest, SaysWhenGzipDataAreCorrupt) {
  std::string packed = Gzip(RandomBytes(200'000, 6));
  for (std::size_t i = packed.size() / 2; i < packed.size() / 2 + 64; ++i) packed[i] = '\xff';
  InputFile file(directory_.Write("corrupt.gz", packed));
  EXPECT_THAT([&] { ReadAll(&file, 4096); },
              ThrowsMessage<Error>(HasSubstr("corrupt.gz: the gzip data are corrupt")));
}

}  // namespace
}  // namespace loopgrid
