#include "apps/online/source/listen_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/tcp.h>
#include <sys/resource.h>

#include <cstring>
#include <filesystem>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "backend/base/error.h"
#include "backend/base/gzip.h"
#include "tests/apps/online/running_source.h"
#include "tests/apps/online/sockets.h"
#include "tests/support/peak_memory.h"
#include "tests/support/portable_random.h"

namespace loopgrid {
namespace {

using test_support::PortableRandom;
using test_support::RunningSource;
using test_support::Socket;
using test_support::WaitUntil;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

constexpr double kForEver = 1e6;  // seconds

ListenOptions OnLoopback(double silence = kForEver) {
  ListenOptions options;
  options.address = {"127.0.0.1", 0};
  options.silence = silence;
  return options;
}

TEST(ListenSource, NamesTheRealPortAndHearsASender) {
  ListenSource source(OnLoopback());
  EXPECT_GT(source.port(), 0);
  EXPECT_EQ(source.name(), "127.0.0.1:" + std::to_string(source.port()));
  RunningSource running(&source);
  const Socket sender = Socket::ConnectTo(source.port());
  sender.Send("one\ntw");
  EXPECT_THAT(running.WaitForLines(1), ElementsAre("one"));
  sender.Send("o\r\nthr");
  EXPECT_THAT(running.WaitForLines(2), ElementsAre("one", "two"));
  running.Stop();
  EXPECT_THAT(running.lines(), ElementsAre("one", "two", "thr~"));
  EXPECT_THAT(running.problem(), IsEmpty());
  EXPECT_TRUE(sender.WaitForEnd());
}

TEST(ListenSource, ListensToOneSenderAfterTheOther) {
  ListenSource source(OnLoopback());
  RunningSource running(&source);
  Socket::ConnectTo(source.port()).Send("a\nb");
  EXPECT_THAT(running.WaitForLines(2), ElementsAre("a", "b~"));
  Socket::ConnectTo(source.port())
      .Send(
          "\xEF\xBB\xBF"
          "c\n");
  EXPECT_THAT(running.WaitForLines(3), ElementsAre("a", "b~", "c"));
  EXPECT_EQ(source.counters().connections, 2);
}

TEST(ListenSource, ASenderMayGoOnlyToComeBackAtOnce) {
  ListenSource source(OnLoopback());
  RunningSource running(&source);
  std::vector<std::string> expected;
  for (int i = 0; i < 50; ++i) {
    expected.push_back(std::to_string(i));
    ASSERT_TRUE(Socket::ConnectTo(source.port()).Send(expected.back() + "\n"));
    // While it is leaving, only one other sender may connect.
    ASSERT_TRUE(WaitUntil([&] { return source.counters().connections > i; }));
  }
  EXPECT_EQ(running.WaitForLines(50), expected);
  EXPECT_EQ(source.counters().refused, 0);
}

TEST(ListenSource, TurnsOthersAwayWhileASenderIsAtIt) {
  ListenSource source(OnLoopback());
  RunningSource running(&source);
  const Socket sender = Socket::ConnectTo(source.port());
  sender.Send("one\n");
  running.WaitForLines(1);
  for (int i = 0; i < 3; ++i) {
    const Socket other = Socket::ConnectTo(source.port());
    other.Send("intruder\n");
    EXPECT_TRUE(other.WaitForEnd());
  }
  EXPECT_EQ(source.counters().refused, 3);
  sender.Send("two\n");
  EXPECT_THAT(running.WaitForLines(2), ElementsAre("one", "two"));
}

TEST(ListenSource, ASilentSenderKeepsItsPlaceUntilItsTimeIsUp) {
  for (const bool time_is_up : {false, true}) {
    ListenSource source(OnLoopback(time_is_up ? 0.0 : kForEver));
    RunningSource running(&source);
    const Socket silent = Socket::ConnectTo(source.port());
    silent.Send("one\ntw");
    running.WaitForLines(1);
    const Socket other = Socket::ConnectTo(source.port());
    if (time_is_up) {
      other.Send("new\n");
      EXPECT_THAT(running.WaitForLines(3), ElementsAre("one", "tw~", "new"));
      EXPECT_TRUE(silent.WaitForEnd());
      EXPECT_EQ(source.counters().refused, 0);
    } else {
      EXPECT_TRUE(other.WaitForEnd());
      silent.Send("o\n");
      EXPECT_THAT(running.WaitForLines(2), ElementsAre("one", "two"));
      EXPECT_EQ(source.counters().refused, 1);
    }
  }
}

TEST(ListenSource, TurnsAwayWhatWebPagesSendAndTellsItOnce) {
  ListenOptions options = OnLoopback();
  options.end_with_sender = true;  // a refused sender does not end the stream
  ListenSource source(options);
  RunningSource running(&source);
  for (int i = 0; i < 3; ++i) {
    const Socket page = Socket::ConnectTo(source.port());
    page.Send("POST / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\nFLASER 3 1 2 3 0 0 0 0 0 0 1 h 1\n");
    EXPECT_TRUE(page.WaitForEnd());
  }
  const Socket packed = Socket::ConnectTo(source.port());
  packed.Send(Gzip("FLASER"));
  EXPECT_TRUE(packed.WaitForEnd());
  Socket::ConnectTo(source.port()).Send("PARAM");  // held back until its end
  running.WaitForEnd();
  EXPECT_THAT(running.lines(), ElementsAre("PARAM~"));
  EXPECT_EQ(source.counters().refused, 4);
  EXPECT_THAT(source.TakeNotices(), ElementsAre(HasSubstr("HTTP"), HasSubstr("gzip -dc")));
  EXPECT_THAT(source.counters().last_problem, HasSubstr("gzip"));
}

TEST(ListenSource, TellsOncePerSenderThatOthersAreTurnedAway) {
  ListenSource source(OnLoopback());
  RunningSource running(&source);
  for (const char* name : {"first\n", "second\n"}) {
    const Socket sender = Socket::ConnectTo(source.port());
    sender.Send(name);
    ASSERT_TRUE(WaitUntil([&] { return running.Count(std::string(name, std::strlen(name) - 1)); }));
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(Socket::ConnectTo(source.port()).WaitForEnd());
    EXPECT_THAT(source.TakeNotices(), ElementsAre("turned a sender away: another one is sending"));
    sender.CloseHalf();
    EXPECT_TRUE(sender.WaitForEnd());
  }
}

TEST(ListenSource, EndsWithTheFirstSenderThatSentSomethingIfTold) {
  ListenOptions options = OnLoopback();
  options.end_with_sender = true;
  ListenSource source(options);
  RunningSource running(&source);
  { const Socket shy = Socket::ConnectTo(source.port()); }
  ASSERT_TRUE(WaitUntil([&] { return source.counters().connections == 1; }));
  Socket::ConnectTo(source.port()).Send("one\ntwo");
  running.WaitForEnd();
  EXPECT_THAT(running.lines(), ElementsAre("one", "two~"));
}

TEST(ListenSource, AHalfClosedSenderHasLeft) {
  ListenSource source(OnLoopback());
  RunningSource running(&source);
  const Socket sender = Socket::ConnectTo(source.port());
  sender.Send("one\ntwo");
  sender.CloseHalf();
  EXPECT_TRUE(sender.WaitForEnd());
  EXPECT_THAT(running.WaitForLines(2), ElementsAre("one", "two~"));
  Socket::ConnectTo(source.port()).Send("three\n");
  EXPECT_EQ(running.WaitForLines(3).back(), "three");
}

TEST(ListenSource, SurvivesAReset) {
  ListenSource source(OnLoopback());
  RunningSource running(&source);
  Socket sender = Socket::ConnectTo(source.port());
  sender.Send("one\ntw");
  running.WaitForLines(1);
  sender.Reset();
  EXPECT_THAT(running.WaitForLines(2), ElementsAre("one", "tw~"));
  EXPECT_THAT(source.counters().last_problem, HasSubstr("reset"));
  Socket::ConnectTo(source.port()).Send("three\n");
  EXPECT_EQ(running.WaitForLines(3).back(), "three");
}

std::vector<std::string> SendInPieces(const std::string& bytes, std::size_t piece) {
  ListenOptions options = OnLoopback();
  options.end_with_sender = true;
  ListenSource source(options);
  RunningSource running(&source);
  const Socket sender = Socket::ConnectTo(source.port());
  const int at_once = 1;
  setsockopt(sender.get(), IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
  for (std::size_t i = 0; i < bytes.size(); i += piece) sender.Send(bytes.substr(i, piece));
  sender.CloseHalf();
  running.WaitForEnd();
  return running.lines();
}

TEST(ListenSource, PacketsOfAnySizeGiveTheSameLines) {
  std::string bytes;
  std::vector<std::string> expected;
  for (int i = 0; i < 400; ++i) {
    expected.push_back(std::to_string(i) + std::string(static_cast<std::size_t>(i % 100), 'x'));
    bytes += expected.back() + "\n";
  }
  EXPECT_EQ(SendInPieces(bytes, 1), expected);
  EXPECT_EQ(SendInPieces(bytes, 1'000), expected);
  EXPECT_EQ(SendInPieces(bytes, std::size_t{1} << 16), expected);
}

TEST(ListenSource, GarbageIsPassedOnAsLinesAndHarmsNobody) {
  PortableRandom random(3);
  std::string garbage;
  for (int i = 0; i < 100'000; ++i)
    garbage += static_cast<char>(static_cast<int>(random.Uniform(0, 256)));
  ListenSource source(OnLoopback());
  RunningSource running(&source);
  Socket::ConnectTo(source.port()).Send(garbage);
  ASSERT_TRUE(WaitUntil(
      [&] { return source.counters().connections == 1 && running.lines().size() > 300; }));
  // Others are refused until all of the garbage is read.
  ASSERT_TRUE(WaitUntil([&] {
    Socket::ConnectTo(source.port()).Send("\nsane\n");
    return running.Count("sane") > 0;
  }));
}

TEST(ListenSource, AnEndlessLineTakesNoMemory) {
  ListenSource source(OnLoopback());
  RunningSource running(&source);
  const Socket sender = Socket::ConnectTo(source.port());
  const std::string piece(std::size_t{1} << 16, 'x');
  sender.Send("one\n");
  running.WaitForLines(1);
  const double before = test_support::ProcessStatusMb("VmHWM:");
  for (int i = 0; i < 2'000; ++i) ASSERT_TRUE(sender.Send(piece));  // 125 MiB
  sender.Send("\ntwo\n");
  EXPECT_THAT(running.WaitForLines(3), ElementsAre("one", "(too long)", "two"));
  EXPECT_LT(test_support::ProcessStatusMb("VmHWM:") - before, 20.0);
}

std::ptrdiff_t OpenDescriptors() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                       std::filesystem::directory_iterator());
}

TEST(ListenSource, ThousandsOfConnectionsLeaveNothingBehind) {
  ListenSource source(OnLoopback());
  RunningSource running(&source);
  Socket::ConnectTo(source.port()).Send("first\n");
  running.WaitForLines(1);
  const std::ptrdiff_t before = OpenDescriptors();
  for (int i = 0; i < 2'000; ++i) {
    Socket visitor = Socket::ConnectTo(source.port());
    if (i % 3 == 1) visitor.Reset();
  }
  Socket::ConnectTo(source.port()).Send("last\n");
  EXPECT_THAT(running.WaitForLines(2), ElementsAre("first", "last"));
  EXPECT_TRUE(WaitUntil([&] { return OpenDescriptors() <= before; })) << OpenDescriptors();
}

TEST(ListenSource, ThousandsOfConnectionsDoNotDisturbASender) {
  ListenSource source(OnLoopback());
  RunningSource running(&source);
  const Socket sender = Socket::ConnectTo(source.port());
  std::vector<std::string> expected;
  for (int i = 0; i < 2'000; ++i) {
    expected.push_back(std::to_string(i));
    ASSERT_TRUE(sender.Send(expected.back() + "\n"));
    Socket::ConnectTo(source.port()).Send("intruder\n");
  }
  EXPECT_EQ(running.WaitForLines(expected.size()), expected);
  EXPECT_TRUE(WaitUntil([&] { return source.counters().refused == 2'000; }));
  EXPECT_EQ(source.counters().connections, 1);
}

TEST(ListenSource, AFullQueueHoldsTheSenderUp) {
  ListenSource source(OnLoopback());
  LineQueue queue(1'000);
  std::thread reader([&] { source.Run(&queue); });
  const Socket sender = Socket::ConnectTo(source.port());
  std::string lines(9'999, 'x');
  lines += '\n';
  std::size_t sent = 0;
  // Wait until the system takes no more bytes, because the source waits for room.
  ASSERT_TRUE(WaitUntil([&] {
    const std::size_t before = sent;
    while (const std::size_t count = sender.SendWithoutWaiting(lines)) sent += count;
    return queue.counters().waits == 1 && sent == before;
  }));
  sender.CloseHalf();
  std::size_t received = 0;
  ReceivedLine line;
  while (received < sent && queue.Pop(&line)) {
    received += line.text.size() + (line.terminated ? 1 : 0);
  }
  EXPECT_EQ(received, sent);
  source.Stop();
  reader.join();
}

TEST(ListenSource, EndsWhenTheMapperClosesAFullQueue) {
  ListenSource source(OnLoopback());
  LineQueue queue(10);
  std::thread reader([&] { source.Run(&queue); });
  const Socket sender = Socket::ConnectTo(source.port());
  sender.Send("one\ntwo\nthree\n");
  ASSERT_TRUE(WaitUntil([&] { return queue.counters().waits == 1; }));
  queue.Close();
  reader.join();
  EXPECT_TRUE(sender.WaitForEnd());
}

TEST(ListenSource, StopsBeforeAndWithoutAnySender) {
  ListenSource early(OnLoopback());
  early.Stop();
  RunningSource first(&early);
  first.WaitForEnd();
  ListenSource source(OnLoopback());
  RunningSource second(&source);
  second.Stop();
  EXPECT_THAT(second.lines(), IsEmpty());
}

TEST(ListenSource, WaitsOutAWantOfDescriptors) {
  ListenSource source(OnLoopback());
  RunningSource running(&source);
  const Socket sender = Socket::ConnectTo(source.port());
  sender.Send("one\n");
  running.WaitForLines(1);
  const Socket second = Socket(Descriptor(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)));
  rlimit before = {};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit none = {3, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  const sockaddr_in address = test_support::LoopbackAddress(source.port());
  const int connected =
      connect(second.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
  const bool noticed = WaitUntil([&] { return !source.counters().last_problem.empty(); });
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_EQ(connected, 0);
  EXPECT_TRUE(noticed);
  EXPECT_TRUE(second.WaitForEnd());  // refused, because the sender is active
  sender.Send("two\n");
  EXPECT_THAT(running.WaitForLines(2), ElementsAre("one", "two"));
}

TEST(ListenSource, RefusesAnAddressThatCannotBeHad) {
  const ListenSource source(OnLoopback());
  const auto listen_at = [](const HostPort& address) {
    return [=] {
      ListenOptions options;
      options.address = address;
      const ListenSource other(options);
    };
  };
  EXPECT_THAT(listen_at({"127.0.0.1", source.port()}),
              ThrowsMessage<Error>(HasSubstr(source.name() + ": cannot listen: ")));
  EXPECT_THAT(listen_at({"192.0.2.1", 0}), ThrowsMessage<Error>(HasSubstr("192.0.2.1:0: cannot")));
}

TEST(ListenSource, ListensByIpv6AndByName) {
  for (const char* host : {"::1", "localhost"}) {
    ListenOptions options = OnLoopback();
    options.address.host = host;
    try {
      const ListenSource source(options);
      EXPECT_GT(source.port(), 0);
    } catch (const Error& error) {
      if (std::string(host) == "::1") GTEST_SKIP() << "no IPv6 here: " << error.what();
      throw;
    }
  }
}

}  // namespace
}  // namespace loopgrid
