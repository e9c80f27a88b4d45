// Messages of `loopgrid online` on standard error while it waits for lines.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <string>
#include <vector>

#include "tests/apps/online/online_program.h"
#include "tests/apps/online/sockets.h"
#include "tests/apps/program.h"
#include "tests/apps/small_log.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::Listener;
using test_support::Program;
using test_support::ProgramResult;
using test_support::SmallLog;
using test_support::Socket;
using test_support::TemporaryDirectory;
using test_support::WaitForEvent;
using ::testing::HasSubstr;

class OnlineNoticesTest : public ::testing::Test {
 protected:
  std::string File(const std::string& name) const { return folder_.File(name); }

  Program Start(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "online");
    arguments.insert(arguments.end(), {"--out", File("live"), "--events", File("events")});
    return Program(arguments);
  }

  int ListeningPort() const {
    const auto start = WaitForEvent(File("events"), "start");
    if (!start) return 0;
    const std::string source = (*start)["source"];
    return std::stoi(source.substr(source.rfind(':') + 1));
  }

  TemporaryDirectory folder_;
};

TEST_F(OnlineNoticesTest, AWebPageIsTurnedAwayWithALineAndLeavesNothingInTheMap) {
  Program program = Start({"--listen", "127.0.0.1:0", "--once"});
  const int port = ListeningPort();
  ASSERT_GT(port, 0);
  const std::string log = SmallLog(5);
  const Socket page = Socket::ConnectTo(port);
  page.Send("POST / HTTP/1.1\r\nContent-Type: text/plain\r\n\r\n" + SmallLog(9));
  EXPECT_TRUE(page.WaitForEnd());
  Socket::ConnectTo(port).Send(log);
  const ProgramResult result = program.Wait();
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(
      result.errors,
      HasSubstr(fmt::format("loopgrid: 127.0.0.1:{}: turned a sender away: it speaks HTTP", port)));
  EXPECT_TRUE(test_support::ReadFile(File("live/journal.clf")) == log);
}

TEST_F(OnlineNoticesTest, ARobotThatCannotBeReachedIsToldOf) {
  std::string address;
  {
    const Listener nobody;
    address = fmt::format("127.0.0.1:{}", nobody.port());
  }
  Program program = Start({"--connect", address, "--quiet"});
  WaitForEvent(File("events"), "warning");
  program.Send(SIGTERM);
  const std::string line = "loopgrid: " + address + ": cannot connect: Connection refused\n";
  const std::string errors = program.Wait().errors;
  EXPECT_THAT(errors, HasSubstr(line));
  EXPECT_EQ(errors.find(line), errors.rfind(line)) << "told twice";
}

TEST_F(OnlineNoticesTest, AFileThatIsNotThereYetIsToldOf) {
  for (const bool is_there : {false, true}) {
    if (is_there) folder_.Write("a.clf", SmallLog(2));
    Program program = Start({"--follow", File("a.clf")});
    WaitForEvent(File("events"), is_there ? "pose" : "start");
    program.Send(SIGTERM);
    const std::string line = "loopgrid: waiting for the file " + File("a.clf") + "\n";
    const std::string errors = program.Wait().errors;
    EXPECT_EQ(errors.find(line) == std::string::npos, is_there) << errors;
  }
}

}  // namespace
}  // namespace loopgrid
