#include "apps/output/kept_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "backend/base/error.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

namespace fs = std::filesystem;
using test_support::ReadFile;
using test_support::TemporaryDirectory;
using Names = std::set<std::string>;

TEST(KeptFile, ComesBackWhateverTookItsPlace) {
  const TemporaryDirectory root;
  root.Write("a", "old");
  root.Write("new", "new");
  for (const bool is_replaced : {false, true}) {
    KeptFile kept(root.File("a"), root.File("second"));
    EXPECT_EQ(ReadFile(root.File("a")), "old") << "nothing changes before it is replaced";
    if (is_replaced) fs::rename(root.File("new"), root.File("a"));
    kept.PutBack();
    EXPECT_EQ(ReadFile(root.File("a")), "old");
  }
  EXPECT_EQ(root.Everything(), Names{"a"});
}

TEST(KeptFile, ThatWasNotThereIsNotThereAgain) {
  const TemporaryDirectory root;
  KeptFile kept(root.File("a"), root.File("second"));
  root.Write("a", "new");
  kept.PutBack();
  EXPECT_EQ(root.Everything(), Names{});
}

TEST(KeptFile, IsGoneWhenForgotten) {
  const TemporaryDirectory root;
  root.Write("a", "old");
  root.Write("new", "new");
  KeptFile kept(root.File("a"), root.File("second"));
  fs::rename(root.File("new"), root.File("a"));
  kept.Forget();
  EXPECT_EQ(root.Everything(), Names{"a"});
  EXPECT_EQ(ReadFile(root.File("a")), "new");
}

TEST(KeptFile, LeavesFoldersAlone) {
  const TemporaryDirectory root;
  fs::create_directory(root.File("a"));
  EXPECT_THAT([&] { KeptFile(root.File("a"), root.File("second")); },
              ::testing::ThrowsMessage<Error>(::testing::HasSubstr("a: is a directory")));
  EXPECT_EQ(root.Everything(), Names{"a"});
}

TEST(KeptFile, KeepsALinkAsALink) {
  const TemporaryDirectory root;
  root.Write("target", "text");
  fs::create_symlink(root.File("target"), root.File("a"));
  KeptFile kept(root.File("a"), root.File("second"));
  fs::remove(root.File("a"));
  kept.PutBack();
  EXPECT_TRUE(fs::is_symlink(root.File("a")));
  EXPECT_EQ(ReadFile(root.File("target")), "text");
}

}  // namespace
}  // namespace loopgrid
