// loopgrid online on a whole recording. Needs LOOPGRID_DATA.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/apps/online/online_program.h"
#include "tests/apps/online/same_files.h"
#include "tests/apps/program.h"
#include "tests/support/recordings.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::ExpectSameFiles;
using test_support::Program;
using test_support::ProgramResult;
using test_support::RunOnline;
using test_support::RunProgram;
using test_support::TemporaryDirectory;
using test_support::WaitUntil;

TEST(OnlineRecording, KilledHalfWayAndResumedGivesTheBytesOfRun) {
  LOOPGRID_REQUIRE_RECORDING(log, "logs/intel.clf");
  const TemporaryDirectory folder;
  const std::string live = folder.File("live");
  const std::string journal = live + "/journal.clf";
  {
    const int input = open(log.c_str(), O_RDONLY | O_CLOEXEC);
    Program program({"online", "--out", live, "--threads", "1", "--quiet"},
                    [input] { dup2(input, STDIN_FILENO); });
    close(input);
    const std::uintmax_t half = std::filesystem::file_size(log) / 2;
    ASSERT_TRUE(WaitUntil([&] {
      return std::filesystem::exists(journal) && std::filesystem::file_size(journal) > half;
    }));
    program.Send(SIGKILL);
    program.Wait();
  }
  const ProgramResult resumed = RunOnline({"--resume", live}, log);
  ASSERT_EQ(resumed.status, 0) << resumed.errors;
  ASSERT_EQ(RunProgram({"run", log, "--out", folder.File("run")}).status, 0);
  ExpectSameFiles(live, folder.File("run"));
}

}  // namespace
}  // namespace loopgrid
