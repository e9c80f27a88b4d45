// Failures of `loopgrid online`: one clear line on standard error, and nothing is lost.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "backend/base/gzip.h"
#include "tests/apps/online/online_program.h"
#include "tests/apps/online/same_files.h"
#include "tests/apps/online/sockets.h"
#include "tests/apps/program.h"
#include "tests/apps/refusal.h"
#include "tests/apps/small_log.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

namespace fs = std::filesystem;
using test_support::ExpectSameFiles;
using test_support::Listener;
using test_support::LongWay;
using test_support::Program;
using test_support::ProgramResult;
using test_support::ReadFile;
using test_support::RunOnline;
using test_support::RunProgram;
using test_support::SmallLog;
using test_support::TemporaryDirectory;
using test_support::WaitForEvent;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class OnlineErrorsTest : public ::testing::Test {
 protected:
  OnlineErrorsTest() { folder_.Write("room.clf", SmallLog(30)); }

  std::string File(const std::string& name) const { return folder_.File(name); }

  /// Expects a refusal that leaves the folder as it was.
  void ExpectRefusal(std::vector<std::string> arguments, int status, const std::string& reason,
                     const std::string& input = "room.clf") const {
    arguments.insert(arguments.begin(), "online");
    test_support::ExpectRefusal(folder_, arguments, status, reason, [this, input] {
      dup2(open(File(input).c_str(), O_RDONLY | O_CLOEXEC), STDIN_FILENO);
    });
  }

  void ExpectOneLine(const ProgramResult& result, int status, const std::string& reason) const {
    EXPECT_EQ(result.status, status);
    EXPECT_THAT(result.errors, AllOf(StartsWith("loopgrid: "), HasSubstr(reason)));
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  }

  TemporaryDirectory folder_;
};

TEST_F(OnlineErrorsTest, ArgumentsThatMakeNoSenseAreAUsageError) {
  const std::string out = File("live");
  ExpectRefusal({}, 2, "--out or --resume is missing");
  ExpectRefusal({"--out", out, "--resume", out}, 2, "--out and --resume");
  ExpectRefusal({"--resume", out, "--continue", out}, 2, "--continue and --resume");
  ExpectRefusal({"--out", out, "--follow", "a", "--listen", "1"}, 2, "more than one");
  ExpectRefusal({"--out", out, "--once"}, 2, "--once is for --listen and --connect");
  ExpectRefusal({"--out", out, "--interval", "nan"}, 2, "--interval is nan");
  ExpectRefusal({"--out", out, "--threads", "0"}, 2, "--threads is 0");
  ExpectRefusal({"--out", out, "--resolution", "0"}, 2, "--resolution is 0");
  ExpectRefusal({"--out", out, "--listen", "nowhere"}, 2, "--listen: 'nowhere' is not");
  ExpectRefusal({"--out", out, "--view", "1:2:3"}, 2, "--view: '1:2:3'");
  ExpectRefusal({"--out", ""}, 2, "--out");
}

TEST_F(OnlineErrorsTest, StreamWithoutScansIsAnInputError) {
  folder_.Write("empty.clf", "");
  ExpectRefusal({"--out", File("live")}, 3, "standard input: no laser scan in it", "empty.clf");
  folder_.Write("none.clf", "FLASER 3 1 2\n");
  const ProgramResult result = RunOnline({"--out", File("live")}, File("none.clf"));
  ExpectOneLine(result, 3, "no laser scan in it (1 malformed lines, the first: ");
}

TEST_F(OnlineErrorsTest, SourceThatCannotBeUsedIsAnInputErrorAndLeavesNothing) {
  const std::string out = File("live");
  folder_.Write("room.clf.gz", Gzip(SmallLog(3)));
  ExpectRefusal({"--out", out}, 3, "standard input: is gzipped", "room.clf.gz");
  ExpectRefusal({"--out", out, "--follow", File("none/log")}, 3, "none/log: ");
  ExpectRefusal({"--out", out, "--follow", File("")}, 3, File(""));
  const Listener taken;
  const std::string address = "127.0.0.1:" + std::to_string(taken.port());
  ExpectRefusal({"--out", out, "--listen", address}, 3, address + ": cannot listen: ");
  ExpectRefusal({"--out", out, "--view", address}, 3, address);
}

TEST_F(OnlineErrorsTest, FolderThatCannotBeUsedIsAnOutputError) {
  const std::string room = File("room.clf");
  ExpectRefusal({"--out", room}, 4, "room.clf: is not a directory");
  ExpectRefusal({"--out", "/proc/loopgrid"}, 4, "/proc/loopgrid: ");
  ExpectRefusal({"--resume", File("none")}, 3, "none: holds no session to resume");
  fs::create_directories(File("live/map.png"));
  ExpectRefusal({"--out", File("live")}, 4, "map.png: is a directory");
}

TEST_F(OnlineErrorsTest, FolderWithASessionIsNotUsedAgain) {
  ASSERT_EQ(RunOnline({"--out", File("live")}, File("room.clf")).status, 0);
  const std::string map = ReadFile(File("live/map.png"));
  ExpectRefusal({"--out", File("live")}, 4, "go on with it (--resume ");
  EXPECT_TRUE(ReadFile(File("live/map.png")) == map);
}

TEST_F(OnlineErrorsTest, EventsThatNobodyTakesStopItWithTheirLinesInTheJournal) {
  const ProgramResult full =
      RunOnline({"--out", File("live"), "--events", "/dev/full"}, File("room.clf"));
  ExpectOneLine(full, 4, "/dev/full: cannot write: No space left on device");
  const auto closed_output = [] {
    int ends[2];
    if (pipe(ends) == 0) dup2(ends[1], STDOUT_FILENO);
    close(ends[0]);
    close(ends[1]);
  };
  const ProgramResult closed =
      RunOnline({"--out", File("other"), "--events", "-"}, File("room.clf"), closed_output);
  ExpectOneLine(closed, 4, "standard output: cannot write: Broken pipe");
}

TEST_F(OnlineErrorsTest, StrictStopsAtTheFirstMalformedLine) {
  folder_.Write("bad.clf", SmallLog(3) + "FLASER 3 1 2\n" + SmallLog(3));
  const ProgramResult result = RunOnline({"--out", File("live"), "--strict"}, File("bad.clf"));
  ExpectOneLine(result, 3, "live/journal.clf:5: ");
}

TEST_F(OnlineErrorsTest, DiskThatFillsUpLosesNothing) {
  ASSERT_EQ(RunProgram({"run", File("room.clf"), "--out", File("run")}).status, 0);
  const std::uintmax_t journal = fs::file_size(File("room.clf"));
  // It stops before the first line, within the lines, at a refresh, or at the end.
  for (const std::uintmax_t limit :
       {std::uintmax_t{50}, journal / 2, journal - 1, journal, journal + journal / 10}) {
    SCOPED_TRACE(limit);
    const std::string out = "live" + std::to_string(limit);
    const ProgramResult full =
        RunOnline({"--out", File(out), "--interval", "0.01"}, File("room.clf"), [limit] {
          const rlimit bytes = {limit, limit};
          setrlimit(RLIMIT_FSIZE, &bytes);
        });
    ExpectOneLine(full, 4, "File too large");
    EXPECT_FALSE(fs::exists(File(out + "/report.json")));
    if (!fs::exists(File(out))) continue;
    ASSERT_EQ(RunOnline({"--resume", File(out)}, File("room.clf")).status, 0);
    ExpectSameFiles(File(out), File("run"));
  }
}

TEST_F(OnlineErrorsTest, FolderThatVanishesIsAnOutputError) {
  folder_.Write("growing.clf", SmallLog(10));
  Program program({"online", "--follow", File("growing.clf"), "--out", File("live"), "--events",
                   File("events"), "--interval", "0.02", "--quiet"});
  WaitForEvent(File("events"), "saved", "scans", 10);
  fs::remove_all(File("live"));
  std::ofstream(File("growing.clf"), std::ios::app) << SmallLog(5);
  const ProgramResult result = program.Wait();
  ExpectOneLine(result, 4, "live/");
  EXPECT_FALSE(fs::exists(File("live")));
}

TEST_F(OnlineErrorsTest, EventsDoNotOverwriteWhatTheSessionReadsOrKeeps) {
  const std::string out = File("live");
  for (const char* name : {"journal.clf", "session.json", "map.png", "../live/./report.json"}) {
    ExpectRefusal({"--out", out, "--events", out + "/" + name}, 2, "is a file of the session");
  }
  ExpectRefusal({"--out", out, "--follow", File("room.clf"), "--events", File("./room.clf")}, 2,
                "room.clf: is the input");
  ASSERT_EQ(RunOnline({"--out", out}, File("room.clf")).status, 0);
  std::filesystem::create_hard_link(File("live/journal.clf"), File("other-name"));
  ExpectRefusal({"--resume", out, "--events", File("other-name")}, 2, "is a file of the session");
  ExpectRefusal({"--resume", out, "--follow", out + "/journal.clf"}, 2,
                "the session's own journal");
  EXPECT_EQ(ReadFile(File("live/journal.clf")), ReadFile(File("room.clf")));
}

TEST_F(OnlineErrorsTest, FoldersThatCannotBeReadAreInputErrors) {
  const TemporaryDirectory links;
  const std::string loop = links.File("loop");
  fs::create_symlink(loop, loop);
  ExpectRefusal({"--resume", loop}, 3, "loop: cannot be read: ");
  ExpectRefusal({"--out", File("live"), "--continue", loop}, 3, "loop: cannot be read: ");
}

TEST_F(OnlineErrorsTest, MapThatWouldBeTooLargeIsDrawnCoarserInTheEnd) {
  folder_.Write("long.clf", LongWay());
  Program program({"online", "--follow", File("long.clf"), "--out", File("live"), "--events",
                   File("events"), "--interval", "0.01", "--resolution", "0.01", "--quiet"});
  WaitForEvent(File("events"), "pose", "scan", 4);
  program.Send(SIGTERM);
  ExpectOneLine(program.Wait(), 0, "note: the map has cells of 0.02 m");
  ASSERT_EQ(
      RunProgram({"run", File("long.clf"), "--out", File("run"), "--resolution", "0.01"}).status,
      0);
  EXPECT_THAT(ReadFile(File("live/map.yaml")), HasSubstr("resolution: 0.02\n"));
  ExpectSameFiles(File("live"), File("run"));
}

TEST_F(OnlineErrorsTest, FolderInUseIsAnOutputError) {
  Program program({"online", "--follow", File("room.clf"), "--out", File("live"), "--events",
                   File("events"), "--interval", "1000", "--quiet"});
  WaitForEvent(File("events"), "pose", "scan", 29);
  WaitForEvent(File("events"), "saved");
  const ProgramResult second = RunOnline({"--resume", File("live")}, File("room.clf"));
  ExpectOneLine(second, 4, "live: is in use by another process");
  program.Send(SIGTERM);
  EXPECT_EQ(program.Wait().status, 0);
}

}  // namespace
}  // namespace loopgrid
