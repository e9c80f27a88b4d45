// The command `loopgrid replay`.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "apps/online/source/listen_source.h"
#include "backend/base/gzip.h"
#include "tests/apps/online/running_source.h"
#include "tests/apps/online/sockets.h"
#include "tests/apps/program.h"
#include "tests/apps/refusal.h"
#include "tests/apps/small_log.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::ExpectRefusal;
using test_support::Listener;
using test_support::Program;
using test_support::ProgramResult;
using test_support::RunningSource;
using test_support::RunProgram;
using test_support::SmallLog;
using test_support::Socket;
using test_support::TemporaryDirectory;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

std::string Scan(double time) {
  return fmt::format("FLASER 1 5 0 0 0 0 0 0 {} h {}\n", time, time);
}

// A log that readers would change: line ends, a byte order mark, garbage, a line without its end.
const std::string kAwkwardLog = "\xEF\xBB\xBF# a log\r\n\n" + Scan(100) + "ODOM 1 2 3\n" +
                                Scan(100.001) + "\t \xFF\xFE\n" + Scan(50) + "FLASER oh\r\nlast";

class ReplayCommandTest : public ::testing::Test {
 protected:
  ProgramResult Replay(const std::string& content, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"replay", folder_.Write("a.clf", content)});
    return RunProgram(more);
  }

  TemporaryDirectory folder_;
};

TEST_F(ReplayCommandTest, PassesTheLogOnByteForByte) {
  for (const char* speed : {"0", "1"}) {
    const ProgramResult result = Replay(kAwkwardLog, {"--speed", speed});
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.output, kAwkwardLog);
    EXPECT_THAT(result.errors, IsEmpty());
  }
  const std::string endless = "#" + std::string(3'000'000, '.') + "\n" + Scan(1);
  EXPECT_EQ(Replay(endless).output, endless);
  const std::string log = SmallLog(300);
  EXPECT_EQ(Replay(Gzip(log), {"--speed", "0"}).output, log);
  EXPECT_EQ(Replay(log, {"--speed", "1000"}).output, log);
}

TEST_F(ReplayCommandTest, NeitherGapsNorAClockThatRunsBackwardsHoldItUp) {
  const std::string log = Scan(1e9) + Scan(2e9) + Scan(-1e9) + Scan(1e9);
  EXPECT_EQ(Replay(log).output, log);
}

TEST_F(ReplayCommandTest, PlaysInALoopAndFromALine) {
  EXPECT_EQ(Replay("a\nb\nc\n", {"--from-line", "2"}).output, "b\nc\n");
  EXPECT_EQ(Replay("a\nb\nc", {"--from-line", "2", "--loop", "3"}).output, "b\nc\nb\nc\nb\nc");
  EXPECT_EQ(Replay("a\n", {"--loop", "2"}).output, "a\na\n");
}

TEST_F(ReplayCommandTest, GivesLinesAtTheirTimeAndASignalEndsItAtALinesEnd) {
  const std::string begin = "# a log\n" + Scan(1) + "ODOM 1 2 3\n";
  const std::string path = folder_.Write("a.clf", begin + Scan(2) + Scan(3));
  for (const int signal : {SIGINT, SIGTERM}) {
    const Listener receiver;
    // The second scan is due in hours.
    Program program({"replay", path, "--speed", "0.0001", "--to",
                     fmt::format("127.0.0.1:{}", receiver.port())});
    const Socket connection = receiver.Accept();
    std::string received;
    while (received.size() < begin.size()) {
      const std::string more = connection.Receive();
      ASSERT_THAT(more, Not(IsEmpty()));
      received += more;
    }
    program.Send(signal);
    EXPECT_EQ(program.Wait().status, 128 + signal);
    received += connection.Receive();
    EXPECT_EQ(received, begin);
  }
}

TEST_F(ReplayCommandTest, PlaysToASocket) {
  ListenOptions options;
  options.address = {"127.0.0.1", 0};
  options.end_with_sender = true;
  ListenSource source(options);
  RunningSource running(&source);
  const ProgramResult result = Replay("a\nb\nlast", {"--to", source.name(), "--loop", "2"});
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, IsEmpty());
  running.WaitForEnd();
  EXPECT_THAT(running.lines(), ::testing::ElementsAre("a", "b", "last", "a", "b", "last~"));
}

TEST_F(ReplayCommandTest, AReceiverThatDoesNotTakeItIsAnOutputError) {
  const std::string log = folder_.Write("a.clf", SmallLog(100));
  std::string free;
  {
    const Listener nobody;
    free = fmt::format("127.0.0.1:{}", nobody.port());
  }
  ExpectRefusal(folder_, {"replay", log, "--to", free}, 4, free + ": cannot connect: ");
  ExpectRefusal(folder_, {"replay", log, "--to", "no-such-host.invalid:7"}, 4,
                "no-such-host.invalid:7: cannot connect: ");
  const auto close_output = [] { close(STDOUT_FILENO); };
  ExpectRefusal(folder_, {"replay", log, "--speed", "0"}, 4, "standard output: ", close_output);
}

TEST_F(ReplayCommandTest, AReceiverThatLeavesOrTurnsItAwayIsAnOutputError) {
  for (const std::string loop : {"0", "1"}) {
    const Listener receiver;
    const std::string address = fmt::format("127.0.0.1:{}", receiver.port());
    Program program({"replay", folder_.Write("a.clf", SmallLog(100)), "--speed", "0", "--to",
                     address, "--loop", loop});
    Socket connection = receiver.Accept();
    connection.Receive();
    connection.Reset();
    const ProgramResult result = program.Wait();
    EXPECT_EQ(result.status, 4);
    EXPECT_THAT(result.errors, AllOf(StartsWith("loopgrid: " + address + ": "), EndsWith("\n")));
  }
}

TEST_F(ReplayCommandTest, ABrokenPipeIsAnOutputError) {
  const auto into_a_broken_pipe = [] {
    int ends[2];
    if (pipe(ends) != 0) _exit(126);
    close(ends[0]);
    dup2(ends[1], STDOUT_FILENO);
  };
  ExpectRefusal(folder_, {"replay", folder_.Write("a.clf", SmallLog(100)), "--loop", "0"}, 4,
                "standard output: cannot write: Broken pipe", into_a_broken_pipe);
}

TEST_F(ReplayCommandTest, WhatCannotBePlayedIsRefused) {
  const std::string log = folder_.Write("a.clf", "a\nb\n");
  ExpectRefusal(folder_, {"replay", folder_.File("none")}, 3, "none: cannot open");
  ExpectRefusal(folder_, {"replay", folder_.File("")}, 3, "is a directory");
  ExpectRefusal(folder_, {"replay", folder_.Write("empty", "")}, 3, "empty: is empty");
  ExpectRefusal(folder_, {"replay", folder_.Write("binary", std::string(9, '\0'))}, 3,
                "binary: only CARMEN logs can be played");
  ExpectRefusal(folder_, {"replay", log, "--from-line", "3"}, 3, "has no line 3, only 2");
  ExpectRefusal(folder_, {"replay", log, "--to", "robot"}, 2, "'robot' is not HOST:PORT");
}

TEST_F(ReplayCommandTest, ALogWithoutScansIsNotPlayedWithoutEnd) {
  const std::string log = folder_.Write("a.clf", "a\n" + Scan(1) + "ODOM 1 2 3\nFLASER oh\n");
  for (const char* speed : {"0", "1"}) {
    ExpectRefusal(folder_, {"replay", log, "--loop", "0", "--from-line", "3", "--speed", speed}, 3,
                  "a.clf: has no scan from line 3 on");
  }
  const std::string empty = folder_.Write("empty.clf", "\n\n");
  ExpectRefusal(folder_, {"replay", empty, "--loop", "0"}, 3, "has no scan from line 1 on");
}

TEST_F(ReplayCommandTest, ALogThatBreaksOffIsPlayedUntilThere) {
  const std::string log = SmallLog(300);
  const std::string packed = Gzip(log);
  const ProgramResult result = Replay(packed.substr(0, packed.size() / 2), {"--speed", "0"});
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.errors, HasSubstr("the gzip data are cut short"));
  EXPECT_THAT(result.output, Not(IsEmpty()));
  EXPECT_THAT(log, StartsWith(result.output));
}

}  // namespace
}  // namespace loopgrid
