#include "apps/output_directory.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

namespace fs = std::filesystem;

class OutputDirectoryTest : public testing::Test {
 protected:
  OutputDirectoryTest() {
    std::string pattern = testing::TempDir() + "loopgrid-XXXXXX";
    root_ = mkdtemp(pattern.data());
  }
  ~OutputDirectoryTest() override { fs::remove_all(root_); }

  static void WriteText(const std::string& path, const std::string& text) {
    std::ofstream(path) << text;
  }

  static std::string Read(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::set<std::string> Everything() const {
    std::set<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(root_)) {
      found.insert(fs::relative(entry.path(), root_));
    }
    return found;
  }

  static void ExpectOutputError(OutputDirectory* outputs, const std::string& message) {
    try {
      outputs->Prepare();
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kOutput);
      EXPECT_EQ(error.what(), message);
    }
  }

  fs::path root_;
};

TEST_F(OutputDirectoryTest, FilesAppearOnlyWithCommitAndNothingElseStays) {
  const fs::path out = root_ / "new" / "out";
  {
    OutputDirectory outputs(out, {"a", "b"});
    outputs.Prepare();
    outputs.Write("a", "first");
    outputs.Write("b", "second");
    EXPECT_FALSE(fs::exists(out / "a"));
    outputs.Commit();
  }
  EXPECT_EQ(Read(out / "a"), "first");
  EXPECT_EQ(Read(out / "b"), "second");
  EXPECT_EQ(Everything(), (std::set<std::string>{"new", "new/out", "new/out/a", "new/out/b"}));
}

TEST_F(OutputDirectoryTest, WithoutCommitNothingStaysNotEvenTheFolder) {
  {
    OutputDirectory outputs(root_ / "new" / "out", {"a", "b"});
    outputs.Prepare();
    outputs.Write("a", "lost");
    outputs.Write("b", [](const std::string& path) { WriteText(path + ".partial", "lost too"); });
  }
  EXPECT_EQ(Everything(), std::set<std::string>{});
}

TEST_F(OutputDirectoryTest, FolderThatWasThereStaysWithWhatItHad) {
  WriteText(root_ / "a", "old");
  {
    OutputDirectory outputs(root_, {"a"});
    outputs.Prepare();
    outputs.Write("a", "new");
  }
  EXPECT_EQ(Everything(), std::set<std::string>{"a"});
  EXPECT_EQ(Read(root_ / "a"), "old");
}

TEST_F(OutputDirectoryTest, CommitReplacesAnEarlierRun) {
  WriteText(root_ / "a", "old");
  OutputDirectory outputs(root_, {"a"});
  outputs.Prepare();
  outputs.Write("a", "new");
  outputs.Commit();
  EXPECT_EQ(Read(root_ / "a"), "new");
}

TEST_F(OutputDirectoryTest, FileThatIsMissingStopsAllOthers) {
  {
    OutputDirectory outputs(root_, {"a", "b"});
    outputs.Prepare();
    outputs.Write("a", "first");
    EXPECT_THROW(outputs.Commit(), Error);
  }
  EXPECT_EQ(Everything(), std::set<std::string>{});
}

TEST_F(OutputDirectoryTest, ErrorsNameTheFinalPlaceOfAFile) {
  OutputDirectory outputs(root_, {"a"});
  outputs.Prepare();
  try {
    outputs.Write("a", [](const std::string& path) {
      throw Error(ErrorCode::kOutput, path + ": the disk is full");
    });
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), (root_ / "a").string() + ": the disk is full");
  }
}

TEST_F(OutputDirectoryTest, FolderThatIsAFileIsRefused) {
  WriteText(root_ / "file", "");
  OutputDirectory outputs(root_ / "file", {"a"});
  ExpectOutputError(&outputs, (root_ / "file").string() + ": is not a directory");
  OutputDirectory below(root_ / "file" / "out", {"a"});
  ExpectOutputError(&below, (root_ / "file").string() + ": is not a directory");
}

TEST_F(OutputDirectoryTest, PlaceOfAFileThatIsAFolderIsRefused) {
  fs::create_directory(root_ / "a");
  OutputDirectory outputs(root_, {"a"});
  ExpectOutputError(&outputs, (root_ / "a").string() +
                                  ": is a directory, and a file of this name is to be written");
}

TEST_F(OutputDirectoryTest, DiscardBeforePrepareLeavesNothingToDo) {
  OutputDirectory outputs(root_ / "new", {"a"});
  outputs.Discard();
  EXPECT_EQ(Everything(), std::set<std::string>{});
}

}  // namespace
}  // namespace loopgrid
