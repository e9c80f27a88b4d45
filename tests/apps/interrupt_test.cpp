// Interrupting the program, and what it shows on a terminal.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/apps/program.h"
#include "tests/apps/small_log.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::Program;
using test_support::ProgramResult;
using test_support::RunProgram;
using test_support::SmallLog;
using test_support::TemporaryDirectory;
using test_support::WriteFile;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Names = std::set<std::string>;
using namespace std::chrono_literals;

/// Runs on a long log, which signals end.
class RunInProgress : public ::testing::Test {
 protected:
  RunInProgress() { WriteFile(folder_.File("long.clf"), SmallLog(20000)); }

  /// Waits until the run has begun to use its output folder.
  void WaitForFolder() const {
    const auto begun = [this] {
      return std::filesystem::exists(out_) && !std::filesystem::is_empty(out_);
    };
    for (int i = 0; i < 6000 && !begun(); ++i) std::this_thread::sleep_for(10ms);
    ASSERT_TRUE(begun()) << "waited a minute for " << out_;
  }

  TemporaryDirectory folder_;
  std::string out_ = folder_.File("new/out");
  std::vector<std::string> arguments_ = {"run", folder_.File("long.clf"), "--out", out_};
};

TEST_F(RunInProgress, StopsAtASignalAndLeavesNothing) {
  for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Program program(arguments_);
    WaitForFolder();
    program.Send(signal);
    const ProgramResult result = program.Wait();
    EXPECT_EQ(result.status, 128 + signal);
    EXPECT_THAT(result.output, IsEmpty());
    EXPECT_EQ(folder_.Everything(), Names{"long.clf"});
  }
}

TEST_F(RunInProgress, KeepsIgnoringSignalsThatItsStarterIgnores) {
  Program program(arguments_, [] { ::signal(SIGHUP, SIG_IGN); });
  WaitForFolder();
  program.Send(SIGHUP);
  program.Send(SIGTERM);
  EXPECT_EQ(program.Wait().status, 128 + SIGTERM);
}

TEST(Interrupt, LeavesAllFilesOrNoneWhereverItFalls) {
  const TemporaryDirectory folder;
  const std::string log = folder.File("room.clf");
  const std::string out = folder.File("out");
  WriteFile(log, SmallLog(60));
  ASSERT_EQ(RunProgram({"run", log, "--out", out}).status, 0);
  const Names all = folder.Everything();
  std::filesystem::remove_all(out);
  int stopped = 0;
  for (int i = 0; i < 40; ++i) {
    Program program({"run", log, "--out", out});
    std::this_thread::sleep_for(i * 10ms);
    program.Send(SIGINT);
    const int status = program.Wait().status;
    // It was killed before it had anything to clean up, was interrupted, or ended before the
    // signal.
    ASSERT_TRUE(status == 1000 + SIGINT || status == 128 + SIGINT || status == 0) << status;
    if (status != 0) ++stopped;
    const Names found = folder.Everything();
    ASSERT_TRUE(found == all || found == Names{"room.clf"}) << ::testing::PrintToString(found);
    std::filesystem::remove_all(out);
  }
  EXPECT_GT(stopped, 0);
}

/// What the program prints on standard error if that is a terminal.
std::string OnTerminal(const std::vector<std::string>& arguments) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  EXPECT_EQ(grantpt(terminal), 0);
  EXPECT_EQ(unlockpt(terminal), 0);
  const std::string name = ptsname(terminal);
  const int other_end = open(name.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  Program program(arguments, [other_end] { dup2(other_end, STDERR_FILENO); });
  EXPECT_EQ(program.Wait().status, 0);
  std::string shown;
  fcntl(terminal, F_SETFL, O_NONBLOCK);
  for (char c = 0; read(terminal, &c, 1) == 1;) shown += c;
  close(other_end);
  close(terminal);
  return shown;
}

TEST(Terminal, ShowsProgressUnlessToldNotTo) {
  const TemporaryDirectory folder;
  const std::string log = folder.File("room.clf");
  WriteFile(log, SmallLog(60));
  const std::string shown = OnTerminal({"run", log, "--out", folder.File("a")});
  EXPECT_THAT(shown, HasSubstr(" scans"));
  EXPECT_THAT(shown, ::testing::EndsWith("\r\033[K"));
  EXPECT_THAT(OnTerminal({"run", log, "--out", folder.File("b"), "--quiet"}), IsEmpty());
}

}  // namespace
}  // namespace loopgrid
