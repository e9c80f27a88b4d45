#include "apps/online/source/connect_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <thread>

#include "backend/base/error.h"
#include "backend/base/gzip.h"
#include "tests/apps/online/running_source.h"
#include "tests/apps/online/sockets.h"

namespace loopgrid {
namespace {

using test_support::Listener;
using test_support::RunningSource;
using test_support::Socket;
using test_support::WaitUntil;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

ConnectOptions To(int port) {
  ConnectOptions options;
  options.address = {"127.0.0.1", port};
  options.first_pause = 0.001;
  options.longest_pause = 0.02;
  return options;
}

/// A port that is free at the moment.
int FreePort() { return Listener().port(); }

TEST(ConnectSource, FetchesLines) {
  const Listener robot;
  ConnectSource source(To(robot.port()));
  EXPECT_EQ(source.name(), "127.0.0.1:" + std::to_string(robot.port()));
  RunningSource running(&source);
  const Socket sender = robot.Accept();
  sender.Send("one\ntw");
  EXPECT_THAT(running.WaitForLines(1), ElementsAre("one"));
  sender.Send("o\r\nthr");
  running.WaitForLines(2);
  running.Stop();
  EXPECT_THAT(running.lines(), ElementsAre("one", "two", "thr~"));
  EXPECT_TRUE(sender.WaitForEnd());
}

TEST(ConnectSource, ComesBackWheneverTheConnectionIsLost) {
  const Listener robot;
  ConnectSource source(To(robot.port()));
  RunningSource running(&source);
  robot.Accept().Send("a\nb");
  running.WaitForLines(2);
  Socket second = robot.Accept();
  second.Send("c\nd");
  running.WaitForLines(3);
  second.Reset();
  robot.Accept().Send("e\n");
  EXPECT_THAT(running.WaitForLines(5), ElementsAre("a", "b~", "c", "d~", "e"));
  EXPECT_GE(source.counters().connections, 3);
}

TEST(ConnectSource, TriesUntilSomebodyIsThere) {
  const int port = FreePort();
  ConnectSource source(To(port));
  RunningSource running(&source);
  ASSERT_TRUE(WaitUntil([&] { return source.counters().failures >= 5; }));
  EXPECT_THAT(source.counters().last_problem, HasSubstr("refused"));
  const Listener robot(port);
  robot.Accept().Send("one\n");
  EXPECT_THAT(running.WaitForLines(1), ElementsAre("one"));
}

TEST(ConnectSource, TellsOnceThatNobodyIsThereUntilSomebodyWas) {
  const int port = FreePort();
  ConnectSource source(To(port));
  RunningSource running(&source);
  const auto fails_five_times = [&source] {
    const std::int64_t before = source.counters().failures;
    return WaitUntil([&] { return source.counters().failures >= before + 5; });
  };
  ASSERT_TRUE(fails_five_times());
  EXPECT_THAT(source.TakeNotices(), ElementsAre(HasSubstr("cannot connect: Connection refused")));
  {
    const Listener robot(port);
    robot.Accept().Send("one\n");
    running.WaitForLines(1);
  }
  ASSERT_TRUE(fails_five_times());
  EXPECT_THAT(source.TakeNotices(), Contains(HasSubstr("cannot connect: Connection refused")));
  ASSERT_TRUE(fails_five_times());
  EXPECT_THAT(source.TakeNotices(), IsEmpty());
}

TEST(ConnectSource, LeavesASenderOfGzippedDataAndTriesAgain) {
  const Listener robot;
  ConnectSource source(To(robot.port()));
  RunningSource running(&source);
  const Socket packed = robot.Accept();
  packed.Send(Gzip("FLASER"));
  EXPECT_TRUE(packed.WaitForEnd());
  EXPECT_THAT(source.TakeNotices(), ElementsAre(HasSubstr("gzip -dc")));
  robot.Accept().Send("one\n");
  EXPECT_THAT(running.WaitForLines(1), ElementsAre("one"));
  EXPECT_EQ(source.counters().failures, 1);
}

TEST(ConnectSource, TriesOnWithANameThatIsNotKnown) {
  ConnectOptions options = To(7070);
  options.address.host = "no-such-host.invalid";
  ConnectSource source(options);
  RunningSource running(&source);
  EXPECT_TRUE(WaitUntil([&] { return source.counters().failures >= 1; }));
}

TEST(ConnectSource, EndsWithTheFirstSenderThatSentSomethingIfTold) {
  const Listener robot;
  ConnectOptions options = To(robot.port());
  options.end_with_sender = true;
  ConnectSource source(options);
  RunningSource running(&source);
  robot.Accept();  // closes the connection at once
  robot.Accept().Send("one\ntwo");
  running.WaitForEnd();
  EXPECT_THAT(running.lines(), ElementsAre("one", "two~"));
}

TEST(ConnectSource, AHalfClosedSenderHasLeft) {
  const Listener robot;
  ConnectSource source(To(robot.port()));
  RunningSource running(&source);
  const Socket sender = robot.Accept();
  sender.Send("one");
  sender.CloseHalf();
  EXPECT_TRUE(sender.WaitForEnd());
  EXPECT_THAT(running.WaitForLines(1), ElementsAre("one~"));
}

TEST(ConnectSource, StopsWhileItDialsWaitsAndReads) {
  ConnectSource never_run(To(1));
  const Listener robot;
  ConnectSource reading(To(robot.port()));
  ConnectOptions patient = To(FreePort());
  patient.first_pause = patient.longest_pause = 1e6;
  ConnectSource waiting(patient);
  RunningSource first(&reading);
  RunningSource second(&waiting);
  const Socket sender = robot.Accept();
  ASSERT_TRUE(WaitUntil([&] { return waiting.counters().failures == 1; }));
  first.Stop();
  second.Stop();
  EXPECT_THAT(first.lines(), IsEmpty());
  ConnectSource early(To(robot.port()));
  early.Stop();
  RunningSource third(&early);
  third.WaitForEnd();
}

TEST(ConnectSource, EndsWhenTheMapperClosesAFullQueue) {
  const Listener robot;
  ConnectSource source(To(robot.port()));
  LineQueue queue(10);
  std::thread reader([&] { source.Run(&queue); });
  const Socket sender = robot.Accept();
  sender.Send("one\ntwo\nthree\n");
  ASSERT_TRUE(WaitUntil([&] { return queue.counters().waits == 1; }));
  queue.Close();
  reader.join();
}

TEST(ConnectSource, RefusesToDialPortZero) {
  EXPECT_THAT([] { ConnectSource source(To(0)); },
              ThrowsMessage<Error>(HasSubstr("127.0.0.1:0: port 0")));
}

}  // namespace
}  // namespace loopgrid
