#include "apps/output/output_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "backend/base/error.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::ReadFile;
using test_support::TemporaryDirectory;
using test_support::WriteFile;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using Names = std::set<std::string>;

TEST(OutputFiles, AppearOnlyWithCommitAndNothingElseStays) {
  const TemporaryDirectory root;
  std::filesystem::create_directory(root.File("deep"));
  const std::string a = root.File("a");
  const std::string b = root.File("deep/b");
  OutputFiles outputs({a, b});
  outputs.Open();
  outputs.Write(a, "first");
  outputs.Write(b, "second");
  EXPECT_FALSE(std::filesystem::exists(a));
  outputs.Commit();
  EXPECT_EQ(ReadFile(a), "first");
  EXPECT_EQ(ReadFile(b), "second");
  EXPECT_EQ(root.Everything(), (Names{"a", "deep", "deep/b"}));
}

TEST(OutputFiles, LeaveWhatWasThereWithoutCommit) {
  const TemporaryDirectory root;
  WriteFile(root.File("a"), "old");
  {
    OutputFiles outputs({root.File("a"), root.File("b")});
    outputs.Open();
    outputs.Write(root.File("a"), "new");
  }
  EXPECT_EQ(root.Everything(), Names{"a"});
  EXPECT_EQ(ReadFile(root.File("a")), "old");
}

TEST(OutputFiles, DiscardRemovesEveryTrace) {
  const TemporaryDirectory root;
  OutputFiles outputs({root.File("a"), root.File("b")});
  outputs.Open();
  EXPECT_EQ(root.Everything().size(), 2u);
  outputs.Discard();
  EXPECT_EQ(root.Everything(), Names{});
}

TEST(OutputFiles, OneThatCannotBeReplacedLeavesAllOthersAsTheyWere) {
  const TemporaryDirectory root;
  WriteFile(root.File("a"), "old a");
  const std::vector<std::string> paths = {root.File("a"), root.File("b"), root.File("c")};
  {
    OutputFiles outputs(paths);
    outputs.Open();
    for (const std::string& path : paths) outputs.Write(path, "new");
    std::filesystem::create_directory(root.File("c"));  // since it was opened
    EXPECT_THROW(outputs.Commit(), Error);
  }
  EXPECT_EQ(root.Everything(), (Names{"a", "c"}));
  EXPECT_EQ(ReadFile(root.File("a")), "old a");
}

TEST(OutputFiles, ReplacesWhatALinkPointsTo) {
  const TemporaryDirectory root;
  WriteFile(root.File("target"), "old");
  std::filesystem::create_symlink(root.File("target"), root.File("link"));
  OutputFiles outputs({root.File("link")});
  outputs.Open();
  outputs.Write(root.File("link"), "new");
  outputs.Commit();
  EXPECT_EQ(ReadFile(root.File("target")), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(root.File("link")));
}

TEST(OutputFiles, OneThatCannotBeWrittenStopsAll) {
  const TemporaryDirectory root;
  OutputFiles missing({root.File("a"), root.File("none/b")});
  EXPECT_THAT([&] { missing.Open(); }, ThrowsMessage<Error>(HasSubstr("none/b: ")));
  OutputFiles folder({root.File("a"), root.File("")});
  EXPECT_THAT([&] { folder.Open(); }, ThrowsMessage<Error>(HasSubstr("is a directory")));
}

TEST(OutputFiles, AFullDiskLeavesNothing) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const TemporaryDirectory root;
  {
    OutputFiles outputs({root.File("a"), "/dev/full"});
    outputs.Open();
    outputs.Write(root.File("a"), "content");
    outputs.Write("/dev/full", "content");
    EXPECT_THAT([&] { outputs.Commit(); }, ThrowsMessage<Error>(HasSubstr("/dev/full: ")));
  }
  EXPECT_EQ(root.Everything(), Names{});
}

TEST(OutputFiles, TwoNamesOfOneFileAreRefused) {
  const TemporaryDirectory root;
  std::filesystem::create_directory(root.File("deep"));
  std::filesystem::create_directory_symlink(root.File("deep"), root.File("link"));
  const auto refuse = [&](const std::string& a, const std::string& b) {
    try {
      const OutputFiles outputs({root.File(a), root.File(b)});
      ADD_FAILURE() << a << " and " << b;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kUsage);
    }
  };
  refuse("a", "a");
  refuse("a", "deep/../a");
  refuse("deep/a", "link/a");
  const OutputFiles different({root.File("a"), root.File("deep/a")});
}

}  // namespace
}  // namespace loopgrid
