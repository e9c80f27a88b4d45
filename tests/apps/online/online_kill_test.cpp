// The program is killed many times, at random moments. At the end the files are the same as
// without.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/apps/online/same_files.h"
#include "tests/apps/program.h"
#include "tests/apps/small_log.h"
#include "tests/support/portable_random.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::ExpectSameFiles;
using test_support::PortableRandom;
using test_support::Program;
using test_support::ProgramResult;
using test_support::ReadFile;
using test_support::RunProgram;
using test_support::SmallLog;
using test_support::TemporaryDirectory;
using ::testing::IsEmpty;
using Clock = std::chrono::steady_clock;

constexpr int kKillsPerTest = 52;

/// A log with everything that makes it hard to find where a stream continues: repeated lines,
/// malformed lines, and a last line that is cut.
std::string AwkwardLog() {
  std::istringstream plain(SmallLog(40));
  std::string log;
  int number = 0;
  for (std::string line; std::getline(plain, line); ++number) {
    log += "ODOM 0 0 0 0 0 0 1 h 1\n" + line + (number % 5 == 3 ? "\r\n" : "\n");
    if (number % 7 == 2) log += "FLASER 3 1 2\n\n";
  }
  return log + "FLASER 180 1.0 2.0";
}

/// The byte behind the line with this number, from 1.
std::size_t EndOfLine(const std::string& log, std::int64_t number) {
  std::size_t end = 0;
  for (std::int64_t line = 0; line < number; ++line) end = log.find('\n', end) + 1;
  return end;
}

/// The last line that was acknowledged; 0 if none was.
std::int64_t LastAcknowledged(const std::string& events) {
  const std::size_t pose = events.rfind("{\"event\":\"pose\"", events.rfind('\n'));
  if (pose == events.npos) return 0;
  return nlohmann::json::parse(events.substr(pose, events.find('\n', pose) - pose))["line"];
}

class Kill : public ::testing::TestWithParam<std::uint32_t> {
 protected:
  Kill() : log_(AwkwardLog()) {
    folder_.Write("log.clf", log_);
    const Clock::time_point start = Clock::now();
    const ProgramResult result = Start("undisturbed", 0, false).Wait();
    whole_time_ = std::chrono::duration<double>(Clock::now() - start).count();
    EXPECT_EQ(result.status, 0) << result.errors;
  }

  /// Starts a session in a folder, or resumes it, on the log from a byte on.
  Program Start(const std::string& folder, std::size_t begin, bool resume) const {
    const int log = open(folder_.File("log.clf").c_str(), O_RDONLY | O_CLOEXEC);
    lseek(log, static_cast<off_t>(begin), SEEK_SET);
    struct Closer {
      int descriptor;
      ~Closer() { close(descriptor); }
    } closer{log};
    std::vector<std::string> arguments = {"online",
                                          "--events",
                                          "-",
                                          "--interval",
                                          "0.01",
                                          "--quiet",
                                          resume ? "--resume" : "--out",
                                          folder_.File(folder)};
    if (!resume) arguments.insert(arguments.end(), {"--resolution", "0.2"});
    return Program(arguments, [log] { dup2(log, STDIN_FILENO); });
  }

  /// Kills it at a random moment and resumes it until it gets to its end; counts the kills.
  void RunUntilDone(PortableRandom* random, const std::string& folder, int* kills) const {
    std::int64_t acknowledged = 0;
    for (bool resume = false;;
         resume = std::filesystem::exists(folder_.File(folder + "/session.json"))) {
      // The sender begins at the first line, after the last acknowledged one, or in between.
      const double share = random->Uniform(-0.5, 1.5);
      const auto line = static_cast<std::int64_t>(std::clamp(share, 0.0, 1.0) *
                                                  static_cast<double>(acknowledged));
      const std::size_t begin = EndOfLine(log_, line);
      Program program = Start(folder, begin, resume);
      if (random->Uniform() < 0.9) {
        // The drawings at the end take much of the time.
        const double latest = random->Uniform() < 0.6 ? 0.4 : 1.0;
        std::this_thread::sleep_for(
            std::chrono::duration<double>(random->Uniform(0.0, latest * whole_time_)));
        program.Send(SIGKILL);
      }
      const ProgramResult result = program.Wait();
      if (result.status == 0) return;
      ASSERT_EQ(result.status, 1000 + SIGKILL) << result.errors;
      ++*kills;
      acknowledged = std::max(acknowledged, LastAcknowledged(result.output));
    }
  }

  TemporaryDirectory folder_;
  std::string log_;
  double whole_time_ = 0.0;  // seconds, of a session that is not killed
};

TEST_P(Kill, AtAnyMomentChangesNothingOnceResumed) {
  SCOPED_TRACE(GetParam());
  PortableRandom random(GetParam());
  int kills = 0;
  for (int session = 0; kills < kKillsPerTest; ++session) {
    const std::string folder = "session" + std::to_string(session);
    RunUntilDone(&random, folder, &kills);
    ExpectSameFiles(folder_.File(folder), folder_.File("undisturbed"));
    EXPECT_TRUE(ReadFile(folder_.File(folder + "/journal.clf")) ==
                ReadFile(folder_.File("undisturbed/journal.clf")));
    for (const auto& entry : std::filesystem::directory_iterator(folder_.File(folder))) {
      EXPECT_NE(entry.path().filename().string().front(), '.') << entry.path();
    }
    ASSERT_FALSE(HasFailure()) << "session " << session << ", " << kills << " kills";
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Kill, ::testing::Values(1u, 2u, 3u, 4u));

}  // namespace
}  // namespace loopgrid
