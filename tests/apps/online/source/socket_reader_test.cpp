#include "apps/online/source/socket_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "tests/apps/online/sockets.h"
#include "tests/apps/online/wait_until.h"

namespace loopgrid {
namespace {

using test_support::Listener;
using test_support::Socket;
using test_support::WaitUntil;
using ::testing::IsEmpty;
using ::testing::Not;
using Outcome = SocketReader::Outcome;

class SocketReaderTest : public ::testing::Test {
 protected:
  Outcome ReadOnceThereIsSomething() {
    Outcome outcome = Outcome::kNothing;
    WaitUntil([&] { return (outcome = reader_->Read(receiver_.get())) != Outcome::kNothing; });
    return outcome;
  }

  Listener listener_;
  Socket sender_ = Socket::ConnectTo(listener_.port());
  Socket receiver_ = listener_.Accept();
  std::unique_ptr<SocketReader> reader_ = std::make_unique<SocketReader>();
};

TEST_F(SocketReaderTest, TakesWhatIsThereAndDoesNotWaitForMore) {
  EXPECT_EQ(reader_->Read(receiver_.get()), Outcome::kNothing);
  sender_.Send("some");
  ASSERT_EQ(ReadOnceThereIsSomething(), Outcome::kBytes);
  EXPECT_EQ(reader_->bytes(), "some");
  EXPECT_EQ(reader_->Read(receiver_.get()), Outcome::kNothing);
}

TEST_F(SocketReaderTest, TellsAGoodEndFromABadOne) {
  sender_.Send("last");
  sender_.CloseHalf();
  ASSERT_EQ(ReadOnceThereIsSomething(), Outcome::kBytes);
  ASSERT_EQ(ReadOnceThereIsSomething(), Outcome::kEnd);
  EXPECT_THAT(reader_->problem(), IsEmpty());
  sender_.Reset();
  const Socket other = Socket::ConnectTo(listener_.port());
  Socket rude = listener_.Accept();
  rude.Reset();
  Outcome outcome = Outcome::kNothing;
  WaitUntil([&] { return (outcome = reader_->Read(other.get())) != Outcome::kNothing; });
  EXPECT_EQ(outcome, Outcome::kEnd);
  EXPECT_THAT(reader_->problem(), Not(IsEmpty()));
}

TEST_F(SocketReaderTest, HasTheSystemAskForDeadPeers) {
  int on = 0;
  socklen_t size = sizeof on;
  KeepAlive(receiver_.get());
  ASSERT_EQ(getsockopt(receiver_.get(), SOL_SOCKET, SO_KEEPALIVE, &on, &size), 0);
  EXPECT_NE(on, 0);
}

}  // namespace
}  // namespace loopgrid
