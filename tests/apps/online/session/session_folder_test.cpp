#include "apps/online/session/session_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include "apps/run/run_outputs.h"
#include "backend/base/error.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::ReadFile;
using test_support::TemporaryDirectory;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

/// A session's folder, open.
struct OpenFolder {
  explicit OpenFolder(const SessionRequest& given)
      : options(given), outputs(given.run.out, RunOutputNames()), folder(&options, &outputs) {}

  SessionRequest options;
  OutputDirectory outputs;
  SessionFolder folder;
};

class SessionFolderTest : public ::testing::Test {
 protected:
  SessionFolderTest() {
    begin_.run.out = folder_.File("live");
    begin_.run.resolution = 0.1;
    begin_.run.slam.node_angle = 1.0 / 3.0;
    resume_.run.out = folder_.File("live");
    resume_.resume = folder_.File("live");
  }

  /// A session of one line.
  void BeginSession() const { OpenFolder(begin_).folder.journal()->Append({.text = "# line"}); }

  void ExpectRefusal(const SessionRequest& options, ErrorCode code,
                     const std::string& reason) const {
    const std::set<std::string> before = folder_.Everything();
    try {
      OpenFolder open(options);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code);
      EXPECT_THAT(error.what(), HasSubstr(reason));
    }
    EXPECT_EQ(folder_.Everything(), before);
  }

  TemporaryDirectory folder_;
  SessionRequest begin_;
  SessionRequest resume_;
};

TEST_F(SessionFolderTest, ResumedSessionHasTheOptionsThatItWasBegunWith) {
  BeginSession();
  OpenFolder resumed(resume_);
  EXPECT_EQ(resumed.options.run.resolution, 0.1);
  EXPECT_EQ(resumed.options.run.slam.node_angle, 1.0 / 3.0);
  EXPECT_FALSE(resumed.options.run.strict);
  EXPECT_EQ(resumed.options.run.log, folder_.File("live/journal.clf"));
  EXPECT_EQ(ReadFile(resumed.options.run.log), "# line\n");
}

TEST_F(SessionFolderTest, OptionThatContradictsTheSessionIsAUsageError) {
  BeginSession();
  resume_.given = {"resolution"};
  ExpectRefusal(resume_, ErrorCode::kUsage, "--resolution is 0.05, but the session");
  resume_.run.resolution = 0.1;
  resume_.given.insert("strict");
  resume_.run.strict = true;
  ExpectRefusal(resume_, ErrorCode::kUsage, "strict is true, but the session");
  resume_.run.strict = false;
  EXPECT_NO_THROW(OpenFolder{resume_});
}

TEST_F(SessionFolderTest, UsedFolderIsNotUsedForANewSession) {
  BeginSession();
  ExpectRefusal(begin_, ErrorCode::kOutput,
                "live: holds a session already: go on with it (--resume");
  EXPECT_EQ(ReadFile(folder_.File("live/journal.clf")), "# line\n");
}

TEST_F(SessionFolderTest, SessionThatReceivedNothingLeavesNothing) {
  { OpenFolder unused(begin_); }
  EXPECT_THAT(folder_.Everything(), IsEmpty());
}

TEST_F(SessionFolderTest, BelongsToOneProcessAtATime) {
  OpenFolder first(begin_);
  first.folder.journal()->Append({.text = "# line"});
  ExpectRefusal(resume_, ErrorCode::kOutput, "live: is in use by another process");
}

TEST_F(SessionFolderTest, NothingToResumeIsAnInputError) {
  ExpectRefusal(resume_, ErrorCode::kInput, "live: holds no session to resume");
  std::filesystem::create_directory(folder_.File("live"));
  ExpectRefusal(resume_, ErrorCode::kInput, "live: holds no session to resume");
  for (const char* damaged : {"", "{}", "[1]", "{\"resolution\": \"x\""}) {
    folder_.Write("live/session.json", damaged);
    ExpectRefusal(resume_, ErrorCode::kInput, "live/session.json: is damaged");
  }
}

TEST_F(SessionFolderTest, RemovesWhatAKilledSessionLeftUnfinished) {
  BeginSession();
  std::filesystem::create_directory(folder_.File("live/.loopgrid-unfinished-abc"));
  folder_.Write("live/.loopgrid-unfinished-abc/map.png", "half");
  folder_.Write("live/.map.png.tmp-123-4", "half");
  folder_.Write("live/.mine.tmp-1", "not ours");
  { OpenFolder resumed(resume_); }
  EXPECT_THAT(folder_.Everything(),
              ::testing::UnorderedElementsAre("live", "live/journal.clf", "live/session.json",
                                              "live/.mine.tmp-1"));
}

TEST_F(SessionFolderTest, ContinuedSessionBeginsWithTheLinesOfTheOther) {
  std::filesystem::create_directory(folder_.File("old"));
  // If the journal exists, it is preferred.
  for (const char* name : {"old/corrected.clf", "old/journal.clf"}) {
    SCOPED_TRACE(name);
    std::filesystem::remove_all(folder_.File("live"));
    folder_.Write(name, std::string(name) + "\r\nFLASER 1 2 cu");
    begin_.continued = folder_.File("old");
    OpenFolder open(begin_);
    EXPECT_EQ(ReadFile(folder_.File("live/journal.clf")),
              std::string(name) + "\nFLASER 1 2 \n# loopgrid new-session\n");
  }
}

TEST_F(SessionFolderTest, NothingToContinueIsAnInputError) {
  begin_.continued = folder_.File("old");
  ExpectRefusal(begin_, ErrorCode::kInput, "old: holds no journal.clf and no corrected.clf");
}

TEST_F(SessionFolderTest, FoldersThatCannotBeReadAreInputErrors) {
  const TemporaryDirectory links;
  const std::string loop = links.File("loop");
  std::filesystem::create_symlink(loop, loop);
  resume_.run.out = resume_.resume = loop;
  ExpectRefusal(resume_, ErrorCode::kInput, "loop: cannot be read: Too many levels");
  begin_.continued = loop;
  ExpectRefusal(begin_, ErrorCode::kInput, "loop: cannot be read: Too many levels");
  // Files in place of folders, folders in place of files.
  folder_.Write("file", "");
  resume_.run.out = resume_.resume = folder_.File("file");
  ExpectRefusal(resume_, ErrorCode::kInput, "file: holds no session to resume");
  begin_.continued = folder_.File("file");
  ExpectRefusal(begin_, ErrorCode::kInput, "file: holds no journal.clf");
  std::filesystem::create_directories(folder_.File("old/journal.clf"));
  begin_.continued = folder_.File("old");
  ExpectRefusal(begin_, ErrorCode::kInput, "old/journal.clf: ");
  std::filesystem::create_directories(folder_.File("odd/session.json"));
  resume_.run.out = resume_.resume = folder_.File("odd");
  ExpectRefusal(resume_, ErrorCode::kInput, "odd/session.json: is damaged");
}

TEST_F(SessionFolderTest, SessionKilledBeforeItHadItsOldLinesGetsThemWhenResumed) {
  std::filesystem::create_directory(folder_.File("old"));
  folder_.Write("old/journal.clf", "# old\n");
  begin_.continued = folder_.File("old");
  {
    OpenFolder open(begin_);
    std::filesystem::remove(folder_.File("live/journal.clf"));
  }
  OpenFolder resumed(resume_);
  EXPECT_EQ(ReadFile(folder_.File("live/journal.clf")), "# old\n# loopgrid new-session\n");
}

}  // namespace
}  // namespace loopgrid
