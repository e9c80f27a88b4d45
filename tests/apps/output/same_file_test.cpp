#include "apps/output/same_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "backend/base/error.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

namespace fs = std::filesystem;
using test_support::TemporaryDirectory;

TEST(IsSameFile, KnowsAFileByAllOfItsNames) {
  const TemporaryDirectory root;
  root.Write("a", "text");
  root.Write("other", "text");
  fs::create_directory(root.File("folder"));
  fs::create_symlink(root.File("a"), root.File("link"));
  fs::create_hard_link(root.File("a"), root.File("hard"));
  for (const char* name : {"a", "./a", "folder/../a", "link", "hard"}) {
    EXPECT_TRUE(IsSameFile(root.File("a"), root.File(name))) << name;
    EXPECT_TRUE(IsSameFile(root.File(name), root.File("a"))) << name;
  }
  EXPECT_FALSE(IsSameFile(root.File("a"), root.File("other")));
}

TEST(IsSameFile, KnowsThePlaceOfAFileThatIsNotThereYet) {
  const TemporaryDirectory root;
  fs::create_directory(root.File("folder"));
  fs::create_directory_symlink(root.File("folder"), root.File("link"));
  EXPECT_TRUE(IsSameFile(root.File("folder/new"), root.File("link/new")));
  EXPECT_TRUE(IsSameFile(root.File("folder/new"), root.File("folder/../link/./new")));
  EXPECT_FALSE(IsSameFile(root.File("folder/new"), root.File("new")));
}

TEST(IsSameFile, TakesNoDeviceAndNoMissingNameForAFile) {
  EXPECT_FALSE(IsSameFile("/dev/null", "/dev/null"));
  EXPECT_FALSE(IsSameFile("", ""));
}

TEST(IsSameFile, StandsLinksThatGoInCircles) {
  const TemporaryDirectory root;
  fs::create_symlink(root.File("loop"), root.File("loop"));
  EXPECT_FALSE(IsSameFile(root.File("loop/a"), root.File("b")));
}

TEST(RequireOtherThanInput, NamesTheOptionAndTheFile) {
  const TemporaryDirectory root;
  root.Write("a", "");
  EXPECT_NO_THROW(RequireOtherThanInput("--out", root.File("b"), root.File("a")));
  try {
    RequireOtherThanInput("--out", root.File("a"), root.File("./a"));
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUsage);
    EXPECT_THAT(error.what(), ::testing::StartsWith("--out " + root.File("a") + ": is the input"));
  }
}

}  // namespace
}  // namespace loopgrid
