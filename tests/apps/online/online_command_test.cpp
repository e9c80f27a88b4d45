// The command `loopgrid online`: it makes the same bytes as `run`, from every source of lines.

#include "apps/online/online_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/tcp.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/apps/online/online_program.h"
#include "tests/apps/online/same_files.h"
#include "tests/apps/online/sockets.h"
#include "tests/apps/program.h"
#include "tests/apps/small_log.h"
#include "tests/support/portable_random.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using nlohmann::json;
using test_support::EventsIn;
using test_support::ExpectSameFiles;
using test_support::Listener;
using test_support::PortableRandom;
using test_support::Program;
using test_support::ProgramResult;
using test_support::ReadFile;
using test_support::RunOnline;
using test_support::RunProgram;
using test_support::SmallLog;
using test_support::Socket;
using test_support::TemporaryDirectory;
using test_support::WaitForEvent;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr int kScans = 30;

/// Each test has a small log, and the files that `run` makes of it.
class OnlineCommandTest : public ::testing::Test {
 protected:
  OnlineCommandTest() {
    folder_.Write("room.clf", log_);
    const ProgramResult run = RunProgram({"run", File("room.clf"), "--out", File("run")});
    EXPECT_EQ(run.status, 0) << run.errors;
  }

  std::string File(const std::string& name) const { return folder_.File(name); }

  /// The port of a program that writes its events to a file.
  int PortOf(const std::string& events) const {
    const auto start = WaitForEvent(File(events), "start");
    const std::string source = start.value_or(json{{"source", ":0"}})["source"];
    return std::stoi(source.substr(source.rfind(':') + 1));
  }

  void ExpectDone(const ProgramResult& result, const std::string& folder) const {
    ASSERT_EQ(result.status, 0) << result.errors;
    ExpectSameFiles(File(folder), File("run"));
  }

  TemporaryDirectory folder_;
  std::string log_ = SmallLog(kScans) + "FLASER 3 1 2\nFLASER 180 1.0 2.0";
};

TEST_F(OnlineCommandTest, PipeGivesTheBytesOfRunAtAnyThreadCount) {
  for (const char* threads : {"1", "2"}) {
    const std::string out = std::string("live") + threads;
    ExpectDone(RunOnline({"--out", File(out), "--threads", threads, "--interval", "0.01"},
                         File("room.clf")),
               out);
    EXPECT_TRUE(ReadFile(File(out + "/journal.clf")) == log_);
  }
}

TEST_F(OnlineCommandTest, FileThatIsFollowedGivesTheBytesOfRun) {
  PortableRandom random(11);
  Program program({"online", "--follow", File("growing.clf"), "--out", File("live"), "--events",
                   File("events"), "--quiet"});
  std::ofstream growing(File("growing.clf"), std::ios::binary);
  for (std::size_t begin = 0; begin < log_.size();) {
    const std::size_t length = 1 + random.Index(3000);
    growing << log_.substr(begin, length) << std::flush;
    begin += length;
  }
  WaitForEvent(File("events"), "pose", "scan", kScans - 1);
  // This line causes a warning, and the one after it is never finished.
  WaitForEvent(File("events"), "warning");
  program.Send(SIGTERM);
  ExpectDone(program.Wait(), "live");
  EXPECT_EQ(EventsIn(File("events")).back()["stopped"], true);
}

TEST_F(OnlineCommandTest, PacketsOfAnySizeGiveTheBytesOfRun) {
  for (const std::size_t size : {std::size_t{1}, std::size_t{1} << 16}) {
    SCOPED_TRACE(size);
    const std::string out = "live" + std::to_string(size);
    Program program({"online", "--listen", "127.0.0.1:0", "--once", "--out", File(out), "--events",
                     File(out + ".events"), "--quiet"});
    {
      const Socket sender = Socket::ConnectTo(PortOf(out + ".events"));
      const int on = 1;
      setsockopt(sender.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      for (std::size_t begin = 0; begin < log_.size(); begin += size) {
        ASSERT_TRUE(sender.Send(log_.substr(begin, size)));
      }
    }
    ExpectDone(program.Wait(), out);
  }
}

TEST_F(OnlineCommandTest, SenderThatIsDialledGivesTheBytesOfRun) {
  const Listener listener;
  Program program({"online", "--connect", "127.0.0.1:" + std::to_string(listener.port()), "--once",
                   "--out", File("live"), "--quiet"});
  EXPECT_TRUE(listener.Accept().Send(log_));
  ExpectDone(program.Wait(), "live");
}

TEST_F(OnlineCommandTest, StoppedAndResumedItGivesTheBytesOfRun) {
  std::size_t half = log_.find('\n', log_.size() / 2) - 100;  // within a line
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const std::string out = "live" + std::to_string(signal);
    Program program({"online", "--listen", "127.0.0.1:0", "--out", File(out), "--events",
                     File(out + ".events"), "--quiet"});
    const Socket sender = Socket::ConnectTo(PortOf(out + ".events"));
    ASSERT_TRUE(sender.Send(log_.substr(0, half)));
    WaitForEvent(File(out + ".events"), "pose", "scan", kScans / 2 - 2);
    program.Send(signal);
    const ProgramResult result = program.Wait();
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_TRUE(std::filesystem::exists(File(out + "/report.json")));
    ExpectDone(RunOnline({"--resume", File(out), "--quiet"}, File("room.clf")), out);
  }
}

TEST_F(OnlineCommandTest, SignalThatComesTwiceIsOneAndLeavesAllFiles) {
  Program program({"online", "--follow", File("room.clf"), "--out", File("live"), "--events",
                   File("events"), "--quiet"});
  WaitForEvent(File("events"), "pose", "scan", kScans - 1);
  WaitForEvent(File("events"), "warning");
  // As timeout(1) does: to the process and to its group, well within a second.
  const auto start = std::chrono::steady_clock::now();
  do {
    program.Send(SIGTERM);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  } while (std::chrono::steady_clock::now() - start < std::chrono::milliseconds(50));
  ExpectDone(program.Wait(), "live");
}

TEST_F(OnlineCommandTest, SecondSignalEndsAtOnceAndLosesNothing) {
  folder_.Write("long.clf", SmallLog(400));
  // The events are not read, so the program can neither continue nor end.
  const int log = open(File("long.clf").c_str(), O_RDONLY | O_CLOEXEC);
  Program program({"online", "--out", File("live"), "--events", "-", "--quiet"},
                  [log] { dup2(log, STDIN_FILENO); });
  close(log);
  const std::string journal = File("live/journal.clf");
  // The pipe takes 64 KiB of events.
  test_support::WaitUntil([&] {
    return std::filesystem::exists(journal) && std::filesystem::file_size(journal) > 200'000;
  });
  program.Send(SIGTERM);
  program.Send(SIGINT);
  const int status = program.Wait().status;
  EXPECT_TRUE(status == 128 + SIGTERM || status == 128 + SIGINT) << status;
  EXPECT_FALSE(std::filesystem::exists(File("live/report.json")));
  ASSERT_EQ(RunOnline({"--resume", File("live")}, File("long.clf")).status, 0);
  ASSERT_EQ(RunProgram({"run", File("long.clf"), "--out", File("run")}).status, 0);
  ExpectSameFiles(File("live"), File("run"));
}

TEST_F(OnlineCommandTest, FilesAreThereWhileMappingGoesOn) {
  Program program({"online", "--follow", File("room.clf"), "--out", File("live"), "--events",
                   File("events"), "--interval", "0.05", "--quiet"});
  WaitForEvent(File("events"), "saved", "scans", kScans);
  const std::string trajectory = ReadFile(File("live/trajectory.tum"));
  EXPECT_EQ(std::count(trajectory.begin(), trajectory.end(), '\n'), kScans);
  for (const char* name : {"map.png", "map.pgm", "map.yaml", "graph.g2o"}) {
    EXPECT_THAT(ReadFile(File(std::string("live/") + name)), Not(IsEmpty())) << name;
  }
  // If no loop was closed, the files while mapping are the same as at the end.
  const std::string map = ReadFile(File("live/map.pgm"));
  EXPECT_FALSE(std::filesystem::exists(File("live/report.json")));
  program.Send(SIGTERM);
  EXPECT_EQ(program.Wait().status, 0);
  EXPECT_TRUE(ReadFile(File("live/map.pgm")) == map);
}

TEST_F(OnlineCommandTest, ContinuedSessionIsWhatRunMakesOfItsJournal) {
  ExpectDone(RunOnline({"--out", File("live")}, File("room.clf")), "live");
  for (const char* old : {"live", "run"}) {
    const std::string out = std::string("on-from-") + old;
    const ProgramResult result =
        RunOnline({"--out", File(out), "--continue", File(old)}, File("room.clf"));
    ASSERT_EQ(result.status, 0) << result.errors;
    const std::string again = out + "-again";
    ASSERT_EQ(RunProgram({"run", File(out + "/journal.clf"), "--out", File(again)}).status, 0);
    ExpectSameFiles(File(out), File(again));
    EXPECT_EQ(test_support::ReportIn(File(out))["scans"], 2 * kScans);
  }
}

TEST_F(OnlineCommandTest, EventsOnStandardOutputAreAlone) {
  const ProgramResult result =
      RunOnline({"--out", File("live"), "--events", "-", "--view", "0"}, File("room.clf"));
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.errors, HasSubstr(" nodes"));
  folder_.Write("events", result.output);
  const std::vector<json> events = EventsIn(File("events"));
  ASSERT_GT(events.size(), 2u);
  EXPECT_EQ(events.front()["event"], "start");
  EXPECT_EQ(events.front()["source"], "standard input");
  EXPECT_THAT(std::string(events.front()["page"]), HasSubstr("http://127.0.0.1:"));
  EXPECT_EQ(events.back()["event"], "end");
  EXPECT_EQ(events.back()["scans"], kScans);
  EXPECT_EQ(events.back()["stopped"], false);
  EXPECT_EQ(std::count_if(events.begin(), events.end(),
                          [](const json& event) { return event["event"] == "pose"; }),
            kScans);
}

TEST_F(OnlineCommandTest, OpenDoorsAreAnnounced) {
  Program program({"online", "--listen", "0.0.0.0:0", "--view", "0.0.0.0:0", "--out", File("live"),
                   "--events", File("events"), "--quiet", "--once"});
  Socket::ConnectTo(PortOf("events")).Send(log_);
  const ProgramResult result = program.Wait();
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("WARNING: 0.0.0.0:"));
  EXPECT_THAT(result.errors, HasSubstr("WARNING: http://"));
}

}  // namespace
}  // namespace loopgrid
