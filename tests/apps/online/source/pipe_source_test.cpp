#include "apps/online/source/pipe_source.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <stdexcept>
#include <string>
#include <thread>

#include "apps/net/descriptor.h"
#include "backend/base/error.h"
#include "backend/base/gzip.h"
#include "tests/apps/online/running_source.h"

namespace loopgrid {
namespace {

using namespace std::string_literals;
using test_support::RunningSource;
using test_support::WaitUntil;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

class PipeSourceTest : public ::testing::Test {
 protected:
  PipeSourceTest() {
    std::signal(SIGPIPE, SIG_IGN);
    std::array<int, 2> ends = {};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    read_end_ = Descriptor(ends[0]);
    write_end_ = Descriptor(ends[1]);
  }

  void Write(const std::string& bytes) const {
    ASSERT_EQ(write(write_end_.get(), bytes.data(), bytes.size()),
              static_cast<ssize_t>(bytes.size()));
  }

  void CloseWriteEnd() { write_end_ = Descriptor(); }

  int BytesInPipe() const {
    int count = -1;
    ioctl(read_end_.get(), FIONREAD, &count);
    return count;
  }

  Descriptor read_end_;
  Descriptor write_end_;
};

TEST_F(PipeSourceTest, GivesEachLineAsSoonAsItIsThereAndEndsWithTheWriter) {
  PipeSource source(read_end_.get(), "standard input");
  EXPECT_EQ(source.name(), "standard input");
  RunningSource running(&source);
  Write("one\ntw");
  EXPECT_THAT(running.WaitForLines(1), ElementsAre("one"));
  Write("o\r\n");
  EXPECT_THAT(running.WaitForLines(2), ElementsAre("one", "two"));
  Write("thr");
  CloseWriteEnd();
  running.WaitForEnd();
  EXPECT_THAT(running.lines(), ElementsAre("one", "two", "thr~"));
  EXPECT_THAT(running.problem(), IsEmpty());
}

TEST_F(PipeSourceTest, StopsThoughNothingComes) {
  PipeSource source(read_end_.get(), "pipe");
  RunningSource running(&source);
  Write("one\ntw");
  running.WaitForLines(1);
  running.Stop();
  EXPECT_THAT(running.lines(), ElementsAre("one", "tw~"));
}

TEST_F(PipeSourceTest, StopsThoughThereIsAlwaysMore) {
  PipeSource source(read_end_.get(), "pipe");
  RunningSource running(&source);
  std::thread writer([&] {
    const std::string lines(40'000, '\n');
    while (write(write_end_.get(), lines.data(), lines.size()) > 0) {
    }
  });
  running.WaitForLines(100'000);
  running.Stop();
  read_end_ = Descriptor();  // so that write() fails
  writer.join();
}

TEST_F(PipeSourceTest, StoppedBeforeItRunsItReadsNothing) {
  Write("one\n");
  PipeSource source(read_end_.get(), "pipe");
  source.Stop();
  RunningSource running(&source);
  running.WaitForEnd();
  EXPECT_THAT(running.lines(), IsEmpty());
}

TEST_F(PipeSourceTest, AFullQueueHoldsTheWriterUp) {
  PipeSource source(read_end_.get(), "pipe");
  LineQueue queue(1'000);
  std::thread reader([&] { source.Run(&queue); });
  std::size_t written = 0;
  fcntl(write_end_.get(), F_SETFL, O_NONBLOCK);
  std::string lines(99, 'x');
  lines += '\n';
  // Wait until the pipe stays full, because the source waits for room.
  ASSERT_TRUE(WaitUntil([&] {
    ssize_t count = 0;
    while ((count = write(write_end_.get(), lines.data(), lines.size())) > 0) {
      written += static_cast<std::size_t>(count);
    }
    return queue.counters().waits == 1 && BytesInPipe() > 0;
  }));
  CloseWriteEnd();
  std::size_t received = 0;
  ReceivedLine line;
  while (queue.Pop(&line)) received += line.text.size() + (line.terminated ? 1 : 0);
  EXPECT_EQ(received, written);
  reader.join();
}

TEST_F(PipeSourceTest, EndsWhenTheMapperClosesAFullQueue) {
  PipeSource source(read_end_.get(), "pipe");
  LineQueue queue(10);
  std::thread reader([&] { source.Run(&queue); });
  Write("one\ntwo\nthree\n");
  ASSERT_TRUE(WaitUntil([&] { return queue.counters().waits == 1; }));
  queue.Close();
  reader.join();
}

TEST_F(PipeSourceTest, PassesOverEndlessLines) {
  PipeSource source(read_end_.get(), "pipe");
  RunningSource running(&source);
  Write("one\n");
  std::thread writer([&] {
    for (int i = 0; i < 48; ++i) Write(std::string(std::size_t{1} << 16, 'x'));  // 3 MiB
    Write("\ntwo\n");
  });
  EXPECT_THAT(running.WaitForLines(3), ElementsAre("one", "(too long)", "two"));
  writer.join();
}

TEST_F(PipeSourceTest, RefusesGzipAndBinaryData) {
  Write(Gzip("FLASER"));
  PipeSource packed(read_end_.get(), "standard input");
  {
    RunningSource running(&packed);
    running.WaitForEnd();
    EXPECT_THAT(running.problem(), StartsWith("standard input: is gzipped: unpack it"));
    EXPECT_THAT(running.lines(), IsEmpty());
  }
  Write("a\n\0"s);
  PipeSource binary(read_end_.get(), "standard input");
  RunningSource running(&binary);
  running.WaitForEnd();
  EXPECT_THAT(running.problem(), StartsWith("standard input: is binary"));
}

TEST_F(PipeSourceTest, RefusesWhatCannotBeReadAtOnce) {
  const auto opening = [](int descriptor) { return [=] { PipeSource(descriptor, "input"); }; };
  EXPECT_THAT(opening(-1), ThrowsMessage<Error>(StartsWith("input: cannot read: ")));
  EXPECT_THAT(opening(write_end_.get()), ThrowsMessage<Error>(StartsWith("input: cannot read: ")));
  const Descriptor folder(open("/", O_RDONLY | O_CLOEXEC));
  EXPECT_THAT(opening(folder.get()), ThrowsMessage<Error>(HasSubstr("directory")));
}

}  // namespace
}  // namespace loopgrid
