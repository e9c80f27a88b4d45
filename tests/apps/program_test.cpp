// The program as a user sees it: files, exit status, output.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <grp.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/apps/online/wait_until.h"
#include "tests/apps/program.h"
#include "tests/apps/refusal.h"
#include "tests/apps/small_log.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test_support::LongWay;
using test_support::ProgramResult;
using test_support::ReadFile;
using test_support::RunProgram;
using test_support::SmallLog;
using test_support::StrayScan;
using test_support::TemporaryDirectory;
using test_support::WriteFile;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using Names = std::set<std::string>;

const Names kOutputs = {"closures.csv",   "corrected.clf",  "graph.g2o", "graph.png",
                        "map.pgm",        "map.png",        "map.yaml",  "report.json",
                        "trajectory.tum", "uncertainty.png"};

constexpr fs::perms kReadable =
    fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read | fs::perms::others_exec;

/// Each test has a folder with a small log in it.
class ProgramTest : public ::testing::Test {
 protected:
  ProgramTest() {
    WriteFile(log_, SmallLog(60));
    for (const std::string& path : {folder_.File(""), log_}) {
      fs::permissions(path, kReadable, fs::perm_options::add);
    }
  }

  ProgramResult Run(const std::string& log, const std::string& out,
                    const std::function<void()>& before = {}) const {
    return RunProgram({"run", log, "--out", out}, before);
  }

  void ExpectRefusal(const std::vector<std::string>& arguments, int status,
                     const std::string& reason, const std::function<void()>& before = {}) const {
    test_support::ExpectRefusal(folder_, arguments, status, reason, before);
  }

  TemporaryDirectory folder_;
  std::string log_ = folder_.File("room.clf");
  std::string out_ = folder_.File("out");
};

/// Root may read and write everything, so tests of permissions need another user.
void BecomeOrdinaryUser() {
  constexpr uid_t kNobody = 65534;
  if (geteuid() != 0) return;
  if (setgroups(0, nullptr) != 0 || setgid(kNobody) != 0 || setuid(kNobody) != 0) _exit(1);
}

bool OrdinaryUserCanRun() { return RunProgram({"--version"}, BecomeOrdinaryUser).status == 0; }

Names FilesIn(const std::string& folder) {
  Names names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

TEST_F(ProgramTest, RunLeavesItsFilesAndASummary) {
  const ProgramResult result = Run(log_, out_);
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.errors, IsEmpty());
  EXPECT_THAT(result.output, AllOf(HasSubstr("60 "), HasSubstr(" nodes"), HasSubstr(out_)));
  EXPECT_EQ(FilesIn(out_), kOutputs);
}

TEST_F(ProgramTest, TwoRunsGiveTheSameBytesButForTimings) {
  const std::string again = folder_.File("again");
  ASSERT_EQ(Run(log_, out_).status, 0);
  ASSERT_EQ(Run(log_, again).status, 0);
  for (const std::string& name : kOutputs) {
    const std::string first = ReadFile(out_ + "/" + name);
    const std::string second = ReadFile(again + "/" + name);
    EXPECT_THAT(first, Not(IsEmpty())) << name;
    if (name == "report.json") continue;
    EXPECT_TRUE(first == second) << name;
  }
  json first = json::parse(ReadFile(out_ + "/report.json"));
  json second = json::parse(ReadFile(again + "/report.json"));
  EXPECT_EQ(first.erase("timings"), 1u);
  EXPECT_EQ(second.erase("timings"), 1u);
  EXPECT_EQ(first, second);
}

TEST_F(ProgramTest, TrajectoryHasEveryScanWithItsOwnTimeStamp) {
  ASSERT_EQ(Run(log_, out_).status, 0);
  std::istringstream trajectory(ReadFile(out_ + "/trajectory.tum"));
  std::string line;
  int scans = 0;
  while (std::getline(trajectory, line)) {
    if (line.starts_with('#')) continue;
    EXPECT_NEAR(std::stod(line), 1000.0 + 0.2 * scans, 1e-6);
    ++scans;
  }
  EXPECT_EQ(scans, 60);
}

TEST_F(ProgramTest, ReportSaysWhatTheOtherFilesShow) {
  ASSERT_EQ(Run(log_, out_).status, 0);
  const json report = json::parse(ReadFile(out_ + "/report.json"));
  EXPECT_EQ(report["scans"], 60);
  EXPECT_EQ(report["log"]["malformed"], 0);
  std::istringstream pgm(ReadFile(out_ + "/map.pgm"));
  std::string magic;
  int width = 0;
  int height = 0;
  pgm >> magic >> width >> height;
  EXPECT_EQ(magic, "P5");
  EXPECT_EQ(report["map"]["width"], width);
  EXPECT_EQ(report["map"]["height"], height);
  EXPECT_THAT(ReadFile(out_ + "/map.yaml"), HasSubstr("map.pgm"));
  const std::string graph = ReadFile(out_ + "/graph.g2o");
  size_t nodes = 0;
  for (size_t at = 0; (at = graph.find("VERTEX_SE2", at)) != std::string::npos; ++at) ++nodes;
  EXPECT_EQ(report["nodes"], nodes);
}

TEST_F(ProgramTest, RunReplacesTheFilesOfAnEarlierRun) {
  ASSERT_EQ(Run(log_, out_).status, 0);
  WriteFile(out_ + "/map.yaml", "old");
  WriteFile(out_ + "/notes.txt", "mine");
  ASSERT_EQ(Run(log_, out_).status, 0);
  EXPECT_NE(ReadFile(out_ + "/map.yaml"), "old");
  EXPECT_EQ(ReadFile(out_ + "/notes.txt"), "mine");
}

TEST_F(ProgramTest, BadLinesAreCountedAndTheMapIsStillMade) {
  WriteFile(log_, "FLASER 3 1 2\n" + SmallLog(60) + "FLASER 180 1.0 2.0 nan");
  const ProgramResult result = Run(log_, out_);
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.output, AllOf(HasSubstr("2 lines skipped"), HasSubstr("room.clf:1: ")));
  const json report = json::parse(ReadFile(out_ + "/report.json"));
  EXPECT_EQ(report["log"]["malformed"], 2);
  EXPECT_EQ(report["log"]["first_problems"].size(), 2u);
  EXPECT_EQ(FilesIn(out_), kOutputs);
}

TEST_F(ProgramTest, OneScanThreeHundredKilometresOffCostsNoFile) {
  WriteFile(log_, SmallLog(30) + StrayScan() + SmallLog(30));
  const ProgramResult result = Run(log_, out_);
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(FilesIn(out_), kOutputs);
  const json report = json::parse(ReadFile(out_ + "/report.json"));
  EXPECT_EQ(report["scans"], 61);
  EXPECT_TRUE(report["notes"].is_array());
  EXPECT_EQ(report["map"]["resolution"], 0.05);
}

TEST_F(ProgramTest, MapThatWouldBeTooLargeIsDrawnCoarserWithANote) {
  WriteFile(log_, LongWay());
  const ProgramResult result = RunProgram({"run", log_, "--out", out_, "--resolution", "0.01"});
  EXPECT_EQ(result.status, 0);
  const std::string note =
      "the map has cells of 0.02 m: with cells of 0.01 m it would be too large";
  EXPECT_EQ(result.errors, "loopgrid: note: " + note + "\n");
  EXPECT_THAT(result.output, HasSubstr("cells of 0.02 m"));
  EXPECT_EQ(FilesIn(out_), kOutputs);
  const json report = json::parse(ReadFile(out_ + "/report.json"));
  EXPECT_EQ(report["notes"], json({note}));
  EXPECT_EQ(report["map"]["resolution"], 0.02);
  EXPECT_EQ(report["options"]["resolution"], 0.01);
  EXPECT_THAT(ReadFile(out_ + "/map.yaml"), HasSubstr("resolution: 0.02\n"));
}

TEST_F(ProgramTest, StrictStopsAtTheFirstBadLine) {
  WriteFile(log_, SmallLog(5) + "FLASER 3 1 2\n" + SmallLog(5));
  ExpectRefusal({"run", log_, "--out", out_, "--strict"}, 3, "room.clf:7: ");
}

TEST_F(ProgramTest, LogThatCannotBeUsedIsAnInputError) {
  ExpectRefusal({"run", folder_.File("none.clf"), "--out", out_}, 3, "none.clf: ");
  ExpectRefusal({"run", folder_.File(""), "--out", out_}, 3, folder_.File(""));
  WriteFile(log_, "");
  ExpectRefusal({"run", log_, "--out", out_}, 3, "room.clf: ");
  WriteFile(log_, "PARAM robot_width 40\nODOM 0 0 0 0 0 0 1 h 1\n");
  ExpectRefusal({"run", log_, "--out", out_}, 3, "no laser scan");
  WriteFile(log_, std::string("\x1f\x8b\x08\x00garbage", 12));
  ExpectRefusal({"run", log_, "--out", out_}, 3, "room.clf: ");
  ExpectRefusal({"run", "/proc/self/mem", "--out", out_}, 3, "/proc/self/mem: ");
}

TEST_F(ProgramTest, FileWithoutPermissionIsAnInputError) {
  if (!OrdinaryUserCanRun()) GTEST_SKIP() << "only root can run the program here";
  fs::permissions(log_, fs::perms::none);
  ExpectRefusal({"run", log_, "--out", out_}, 3, "room.clf: cannot open: Permission denied",
                BecomeOrdinaryUser);
}

TEST_F(ProgramTest, FolderThatCannotBeWrittenIsAnOutputError) {
  ExpectRefusal({"run", log_, "--out", log_}, 4, "room.clf: is not a directory");
  ExpectRefusal({"run", log_, "--out", log_ + "/out"}, 4, "room.clf: is not a directory");
  ExpectRefusal({"run", log_, "--out", ""}, 2, "--out: the name is empty");
  ExpectRefusal({"run", log_, "--out", "/proc/loopgrid"}, 4, "/proc/loopgrid: ");
  ExpectRefusal({"run", log_, "--out", "/dev/null"}, 4, "/dev/null: is not a directory");
  fs::create_directories(out_ + "/map.png");
  ExpectRefusal({"run", log_, "--out", out_}, 4, "map.png: is a directory");
}

TEST_F(ProgramTest, FolderOfASessionIsNotOverwritten) {
  fs::create_directory(out_);
  for (const char* name : {"session.json", "journal.clf"}) {
    WriteFile(out_ + "/" + name, "{}");
    ExpectRefusal({"run", log_, "--out", out_}, 4, "out: holds a session of loopgrid online");
    fs::remove(out_ + "/" + name);
  }
}

TEST_F(ProgramTest, RunDoesNotOverwriteItsOwnLog) {
  ASSERT_EQ(Run(log_, out_).status, 0);
  const std::string corrected = out_ + "/corrected.clf";
  ExpectRefusal({"run", corrected, "--out", out_}, 2, "corrected.clf: is the input");
  fs::create_hard_link(log_, out_ + "/linked.clf");
  fs::remove(corrected);
  fs::rename(out_ + "/linked.clf", corrected);
  ExpectRefusal({"run", log_, "--out", out_}, 2, "corrected.clf: is the input");
}

TEST_F(ProgramTest, FolderInUseByAnotherRunIsAnOutputError) {
  WriteFile(folder_.File("long.clf"), SmallLog(20000));
  test_support::Program first({"run", folder_.File("long.clf"), "--out", out_});
  ASSERT_TRUE(test_support::WaitUntil([this] { return fs::exists(out_) && !fs::is_empty(out_); }));
  ExpectRefusal({"run", log_, "--out", out_}, 4, "out: is in use by another process");
  first.Send(SIGKILL);
  first.Wait();
  EXPECT_FALSE(fs::is_empty(out_)) << "what a killed run leaves";
  ASSERT_EQ(Run(log_, out_).status, 0);
  EXPECT_EQ(FilesIn(out_), kOutputs);
}

TEST_F(ProgramTest, LinksThatGoInCirclesAreErrorsWithAName) {
  const TemporaryDirectory links;
  const std::string loop = links.File("loop");
  fs::create_symlink(loop, loop);
  ExpectRefusal({"run", loop, "--out", out_}, 3, "loop: ");
  ExpectRefusal({"run", log_, "--out", loop}, 4, "loop: ");
  ExpectRefusal({"run", log_, "--out", loop + "/out"}, 4, "loop");
}

TEST_F(ProgramTest, FolderWithoutPermissionIsAnOutputError) {
  if (!OrdinaryUserCanRun()) GTEST_SKIP() << "only root can run the program here";
  fs::create_directory(out_);
  fs::permissions(out_, kReadable);
  ExpectRefusal({"run", log_, "--out", out_}, 4, "out: Permission denied", BecomeOrdinaryUser);
  ExpectRefusal({"run", log_, "--out", out_ + "/deeper"}, 4, "out/deeper: Permission denied",
                BecomeOrdinaryUser);
}

TEST_F(ProgramTest, OutputIsTriedBeforeTheLogIsRead) {
  // The log has one bad line, at which a strict run would stop if it read the log.
  WriteFile(log_, SmallLog(1) + "FLASER 3 1 2\n");
  ExpectRefusal({"run", log_, "--out", "/dev/null", "--strict"}, 4, "/dev/null: ");
}

TEST_F(ProgramTest, DiskThatFillsUpLeavesNothingNew) {
  ASSERT_EQ(Run(log_, out_).status, 0);
  uintmax_t largest = 0;
  for (const std::string& name : kOutputs) {
    largest = std::max(largest, fs::file_size(out_ + "/" + name));
  }
  const std::string map = ReadFile(out_ + "/map.png");
  for (uintmax_t limit : {uintmax_t{0}, uintmax_t{100}, largest / 2, largest - 1}) {
    const auto limit_files = [limit] {
      const rlimit bytes = {limit, limit};
      setrlimit(RLIMIT_FSIZE, &bytes);
    };
    ExpectRefusal({"run", log_, "--out", folder_.File("new")}, 4, "new/", limit_files);
    ExpectRefusal({"run", log_, "--out", out_}, 4, "out/", limit_files);
    EXPECT_TRUE(ReadFile(out_ + "/map.png") == map);
  }
}

TEST_F(ProgramTest, OptionOutOfRangeIsAUsageErrorWithValueAndBound) {
  ExpectRefusal({"run", log_, "--out", out_, "--resolution", "0"}, 2,
                "--resolution is 0, expected 0.01 to 1");
  ExpectRefusal({"run", log_, "--out", out_, "--resolution", "nan"}, 2, "--resolution is nan");
  ExpectRefusal({"run", log_, "--out", out_, "--node-distance", "-1"}, 2, "--node-distance is -1");
  ExpectRefusal({"run", log_, "--out", out_, "--node-angle", "1e9"}, 2, "--node-angle is ");
}

TEST_F(ProgramTest, WithoutArgumentsItPrintsTheCommandsAsAUsageError) {
  const ProgramResult result = RunProgram({});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.output, "");
  EXPECT_EQ(result.errors, RunProgram({"--help"}).output);
  for (const char* command : {"run", "online", "eval", "optimize", "plot", "replay"}) {
    EXPECT_THAT(result.errors, ::testing::HasSubstr(std::string("\n  ") + command + ' '));
  }
}

TEST_F(ProgramTest, ArgumentsThatMakeNoSenseAreAUsageError) {
  ExpectRefusal({"fly"}, 2, "there is no command 'fly' (see loopgrid --help)");
  ExpectRefusal({"optimise"}, 2, "did you mean optimize?");
  ExpectRefusal({"run"}, 2, "LOG");
  ExpectRefusal({"run", log_}, 2, "--out");
  ExpectRefusal({"run", log_, "--out", out_, "--fast"}, 2, "--fast");
  ExpectRefusal({"run", log_, "--out", out_, "--resolutoin", "1"}, 2,
                "did you mean --resolution? (see loopgrid run --help)");
  ExpectRefusal({"run", log_, "--out", out_, "--resolution", "fine\ngrained"}, 2, "fine grained");
  ExpectRefusal({"eval", log_}, 2, "REFERENCE");
}

TEST_F(ProgramTest, UsageIsCheckedBeforeInputAndInputBeforeOutput) {
  const std::string missing = folder_.File("none.clf");
  ExpectRefusal({"run", missing, "--out", "/dev/null", "--resolution", "0"}, 2, "resolution");
  ExpectRefusal({"run", missing, "--out", "/dev/null"}, 3, "none.clf");
}

TEST_F(ProgramTest, HelpAndVersionGoToStandardOutput) {
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"--help"}, {"run", "--help"}, {"eval", "--help"}, {"--version"}}) {
    const ProgramResult result = RunProgram(arguments);
    EXPECT_EQ(result.status, 0);
    EXPECT_THAT(result.output, HasSubstr("loopgrid"));
    EXPECT_THAT(result.errors, IsEmpty());
  }
}

TEST_F(ProgramTest, StandardOutputThatCannotBeWrittenIsAnOutputError) {
  const auto to_full_device = [] { dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO); };
  ExpectRefusal({"--help"}, 4, "standard output: No space left", to_full_device);
  ExpectRefusal({"--help"}, 4, "standard output: ", [] { close(STDOUT_FILENO); });
  const auto to_closed_pipe = [] {
    int ends[2];
    if (pipe(ends) == 0) dup2(ends[1], STDOUT_FILENO);
    close(ends[0]);
    close(ends[1]);
  };
  ExpectRefusal({"--help"}, 4, "standard output: Broken pipe", to_closed_pipe);
}

TEST_F(ProgramTest, ClosedStandardStreamsDoNotMixWithTheFiles) {
  const std::string other = folder_.File("other");
  ASSERT_EQ(Run(log_, out_).status, 0);
  const ProgramResult result = Run(log_, other, [] {
    for (int descriptor : {0, 1, 2}) close(descriptor);
  });
  // The summary could not be printed, but the files are complete.
  EXPECT_EQ(result.status, 4);
  for (const std::string& name : kOutputs) {
    if (name == "report.json") continue;
    EXPECT_TRUE(ReadFile(out_ + "/" + name) == ReadFile(other + "/" + name)) << name;
  }
}

}  // namespace
}  // namespace loopgrid
