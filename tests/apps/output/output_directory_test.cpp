#include "apps/output/output_directory.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "backend/base/error.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::ReadFile;
using test_support::TemporaryDirectory;
using test_support::WriteFile;

void ExpectOutputError(OutputDirectory* outputs, const std::string& message) {
  try {
    outputs->Prepare();
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kOutput);
    EXPECT_EQ(error.what(), message);
  }
}

using Names = std::set<std::string>;

TEST(OutputDirectory, FilesAppearOnlyWithCommitAndNothingElseStays) {
  const TemporaryDirectory root;
  const std::string out = root.File("new/out");
  {
    OutputDirectory outputs(out, {"a", "b"});
    outputs.Prepare();
    outputs.Write("a", "first");
    outputs.Write("b", "second");
    EXPECT_FALSE(std::filesystem::exists(out + "/a"));
    outputs.Commit();
  }
  EXPECT_EQ(ReadFile(out + "/a"), "first");
  EXPECT_EQ(ReadFile(out + "/b"), "second");
  EXPECT_EQ(root.Everything(), (Names{"new", "new/out", "new/out/a", "new/out/b"}));
}

TEST(OutputDirectory, WithoutCommitNothingStaysNotEvenTheFolder) {
  const TemporaryDirectory root;
  {
    OutputDirectory outputs(root.File("new/out"), {"a", "b"});
    outputs.Prepare();
    outputs.Write("a", "lost");
    outputs.Write("b", [](const std::string& path) { WriteFile(path + ".partial", "lost too"); });
  }
  EXPECT_EQ(root.Everything(), Names{});
}

TEST(OutputDirectory, FolderThatWasThereStaysWithWhatItHad) {
  const TemporaryDirectory root;
  WriteFile(root.File("a"), "old");
  {
    OutputDirectory outputs(root.File(""), {"a"});
    outputs.Prepare();
    outputs.Write("a", "new");
  }
  EXPECT_EQ(root.Everything(), Names{"a"});
  EXPECT_EQ(ReadFile(root.File("a")), "old");
}

TEST(OutputDirectory, CommitReplacesAnEarlierRun) {
  const TemporaryDirectory root;
  WriteFile(root.File("a"), "old");
  OutputDirectory outputs(root.File(""), {"a"});
  outputs.Prepare();
  outputs.Write("a", "new");
  outputs.Commit();
  EXPECT_EQ(ReadFile(root.File("a")), "new");
}

TEST(OutputDirectory, FileThatIsMissingStopsAllOthers) {
  const TemporaryDirectory root;
  {
    OutputDirectory outputs(root.File(""), {"a", "b"});
    outputs.Prepare();
    outputs.Write("a", "first");
    EXPECT_THROW(outputs.Commit(), Error);
  }
  EXPECT_EQ(root.Everything(), Names{});
}

TEST(OutputDirectory, ErrorsNameTheFinalPlaceOfAFile) {
  const TemporaryDirectory root;
  OutputDirectory outputs(root.File(""), {"a"});
  outputs.Prepare();
  try {
    outputs.Write("a", [](const std::string& path) {
      throw Error(ErrorCode::kOutput, path + ": the disk is full");
    });
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), root.File("a") + ": the disk is full");
  }
}

TEST(OutputDirectory, FolderThatIsAFileIsRefused) {
  const TemporaryDirectory root;
  WriteFile(root.File("file"), "");
  OutputDirectory outputs(root.File("file"), {"a"});
  ExpectOutputError(&outputs, root.File("file") + ": is not a directory");
  OutputDirectory below(root.File("file/out"), {"a"});
  ExpectOutputError(&below, root.File("file") + ": is not a directory");
}

TEST(OutputDirectory, PlaceOfAFileThatIsAFolderIsRefused) {
  const TemporaryDirectory root;
  std::filesystem::create_directory(root.File("a"));
  OutputDirectory outputs(root.File(""), {"a"});
  ExpectOutputError(&outputs,
                    root.File("a") + ": is a directory, and a file of this name is to be written");
}

TEST(OutputDirectory, FileThatCannotBeReplacedLeavesAllOthersAsTheyWere) {
  const TemporaryDirectory root;
  WriteFile(root.File("a"), "old a");
  WriteFile(root.File("c"), "old c");
  {
    OutputDirectory outputs(root.File(""), {"a", "b", "c", "d"});
    outputs.Prepare();
    for (const char* name : {"a", "b", "c", "d"}) outputs.Write(name, "new");
    std::filesystem::create_directory(root.File("d"));  // since it was looked at
    EXPECT_THROW(outputs.Commit(), Error);
  }
  EXPECT_EQ(root.Everything(), (Names{"a", "c", "d"}));
  EXPECT_EQ(ReadFile(root.File("a")), "old a");
  EXPECT_EQ(ReadFile(root.File("c")), "old c");
}

TEST(OutputDirectory, FileThatIsLeftOutGoesWithTheEarlierRun) {
  const TemporaryDirectory root;
  WriteFile(root.File("b"), "old");
  OutputDirectory outputs(root.File(""), {"a", "b", "c"});
  outputs.Prepare();
  outputs.Write("a", "new");
  outputs.LeaveOut("b");
  outputs.LeaveOut("c");
  EXPECT_EQ(ReadFile(root.File("b")), "old");
  outputs.Commit();
  EXPECT_EQ(root.Everything(), Names{"a"});
}

TEST(OutputDirectory, BelongsToOneAtATime) {
  const TemporaryDirectory root;
  {
    OutputDirectory first(root.File("out"), {"a"});
    first.Prepare();
    const Names before = root.Everything();
    {
      OutputDirectory second(root.File("out"), {"b"});
      ExpectOutputError(&second, root.File("out") + ": is in use by another process");
    }
    EXPECT_EQ(root.Everything(), before);
    first.Write("a", "first");
    first.Commit();
  }
  OutputDirectory later(root.File("out"), {"a"});
  later.Prepare();
  EXPECT_EQ(ReadFile(root.File("out/a")), "first");
}

TEST(OutputDirectory, RemovesWhatAKilledProcessLeftUnfinished) {
  const TemporaryDirectory root;
  std::filesystem::create_directory(root.File(".loopgrid-unfinished-abc"));
  WriteFile(root.File(".loopgrid-unfinished-abc/a"), "half");
  WriteFile(root.File(".a.tmp-123-4"), "half");
  WriteFile(root.File(".mine.tmp-1"), "not ours");
  {
    OutputDirectory outputs(root.File(""), {"a"});
    outputs.Prepare();
  }
  EXPECT_EQ(root.Everything(), Names{".mine.tmp-1"});
}

TEST(OutputDirectory, DiscardBeforePrepareLeavesNothingToDo) {
  const TemporaryDirectory root;
  OutputDirectory outputs(root.File("new"), {"a"});
  outputs.Discard();
  EXPECT_EQ(root.Everything(), Names{});
}

}  // namespace
}  // namespace loopgrid
