#include "apps/view/http_service.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "backend/base/error.h"
#include "tests/apps/online/wait_until.h"
#include "tests/apps/view/wire.h"
#include "tests/support/http_client.h"

namespace loopgrid {
namespace {

using test_support::AskOnce;
using test_support::HttpClient;
using test_support::HttpReply;
using test_support::WaitUntil;
using test_support::Wire;

constexpr const char* kGet = "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n";
constexpr const char* kFollow = "GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n";

/// Answers "hello" to every request, and sends the events that the test sets.
class Greeter : public HttpContent {
 public:
  Reply Answer(const Request& request) override {
    Reply reply;
    reply.body = std::make_shared<const std::string>("hello " + std::string(request.target));
    reply.follows_events = request.target == "/events" || request.target == "/long-snapshot";
    if (request.target == "/long-snapshot") snapshot_size_ = 20'000'000;
    if (request.target == "/large") reply.body = std::make_shared<std::string>(20'000'000, 'x');
    return reply;
  }

  std::shared_ptr<const std::string> TakeNews() override {
    const std::lock_guard lock(mutex_);
    if (news_.empty()) return nullptr;
    told_ += news_.size();
    return std::make_shared<const std::string>(std::exchange(news_, {}));
  }

  std::shared_ptr<const std::string> Snapshot() override {
    const std::lock_guard lock(mutex_);
    return std::make_shared<const std::string>("snapshot after " + std::to_string(told_) + ";" +
                                               std::string(snapshot_size_, ' '));
  }

  void Tell(const std::string& news) {
    const std::lock_guard lock(mutex_);
    news_ += news;
  }

 private:
  std::mutex mutex_;
  std::string news_;
  std::size_t told_ = 0;
  std::size_t snapshot_size_ = 0;  // of the blanks behind it
};

ViewServerOptions QuickOptions() {
  ViewServerOptions options;
  options.batch_interval = 0.002;
  return options;
}

class HttpServiceTest : public testing::Test {
 protected:
  void Start(const ViewServerOptions& options = QuickOptions()) {
    service_ = std::make_unique<HttpService>(options);
    service_->Start(&content_);
  }

  int port() const { return service_->port(); }
  HttpCounters counters() const { return service_->counters(); }
  bool Works() const { return AskOnce(port(), {}).body == "hello /"; }

  Greeter content_;
  std::unique_ptr<HttpService> service_;
};

TEST_F(HttpServiceTest, AnswersManyRequestsOnOneConnection) {
  Start();
  HttpClient client(port());
  for (int i = 0; i < 20; ++i) {
    const HttpReply reply = client.Get("/" + std::to_string(i));
    EXPECT_EQ(reply.status, 200);
    EXPECT_EQ(reply.body, "hello /" + std::to_string(i));
    EXPECT_EQ(reply.headers.at("content-length"), std::to_string(reply.body.size()));
  }
  EXPECT_EQ(counters().connections, 1);
  EXPECT_EQ(counters().requests, 20);
}

TEST_F(HttpServiceTest, AnswersRequestsThatComeTogetherInOrder) {
  Start();
  Wire wire(port(),
            std::string("GET /1 HTTP/1.1\r\n\r\nGET /2 HTTP/1.1\r\nConnection: close\r\n\r\n"));
  EXPECT_TRUE(wire.WaitForEnd());
  EXPECT_LT(wire.received().find("hello /1"), wire.received().find("hello /2"));
  EXPECT_NE(wire.received().find("hello /2"), std::string::npos);
}

TEST_F(HttpServiceTest, TellsTheLengthButSendsNoBodyForHead) {
  Start();
  HttpClient client(port());
  const HttpReply reply = client.Ask({.method = "HEAD", .target = "/x"});
  EXPECT_EQ(reply.headers.at("content-length"), "8");
  EXPECT_EQ(client.Get("/y").body, "hello /y") << "the connection is still good";
  EXPECT_EQ(AskOnce(port(), {.method = "HEAD", .target = "/events"}).body, "");
  EXPECT_EQ(counters().viewers, 0);
}

TEST_F(HttpServiceTest, SendsLargeBodiesWhole) {
  Start();
  const HttpReply reply = AskOnce(port(), {.target = "/large"});
  EXPECT_TRUE(reply.body == std::string(20'000'000, 'x'));
}

TEST_F(HttpServiceTest, RefusesBodiesAndHeadersThatAreTooLong) {
  Start();
  EXPECT_EQ(AskOnce(port(), {.body = "some"}).status, 413);
  EXPECT_EQ(AskOnce(port(), {.headers = {{"X-Long", std::string(9000, 'x')}}}).status, 431);
  EXPECT_EQ(AskOnce(port(), {.target = "/" + std::string(9000, 'x')}).status, 431);
  EXPECT_EQ(AskOnce(port(), {.headers = {{"X-Long", std::string(7000, 'x')}}}).status, 200);
}

TEST_F(HttpServiceTest, RefusesMoreThanOneHost) {
  Start();
  for (const char* second : {"localhost", "evil.example", ""}) {
    Wire wire(port(),
              std::string("GET / HTTP/1.1\r\nHost: localhost\r\nhOST: ") + second + "\r\n\r\n");
    EXPECT_TRUE(wire.WaitForEnd());
    EXPECT_TRUE(wire.received().starts_with("HTTP/1.1 400 ")) << wire.received();
    EXPECT_EQ(wire.received().find("hello"), std::string::npos);
  }
}

TEST_F(HttpServiceTest, SurvivesEndlessHeaders) {
  Start();
  Wire wire(port(), "GET / HTTP/1.1\r\n");
  const std::string line = "X: " + std::string(1000, 'x') + "\r\n";
  for (int i = 0; i < 5000 && wire.Send(line); ++i) continue;
  EXPECT_TRUE(wire.WaitForEnd());
  EXPECT_TRUE(Works());
}

TEST_F(HttpServiceTest, SurvivesGarbage) {
  Start();
  const std::string tls_hello("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11);
  const std::vector<std::string> garbage = {
      "\r\n\r\n\r\n",
      "GET\r\n\r\n",
      "GET / HTTP/9.9\r\n\r\n",
      "GET / HTTP/1.1\r\nno colon\r\n\r\n",
      "GET / HTTP/1.1\r\nContent-Length: -1\r\n\r\n",
      "GET / HTTP/1.1\r\nContent-Length: 99999999999999999999\r\n\r\n",
      tls_hello + std::string(500, '\x01'),
      std::string(3000, '\0'),
      std::string(100'000, '\xff')};
  for (const std::string& bytes : garbage) {
    Wire wire(port(), bytes);
    wire.socket().CloseHalf();
    EXPECT_TRUE(wire.WaitForEnd());
    EXPECT_EQ(wire.received().find("hello"), std::string::npos);
    EXPECT_TRUE(Works());
  }
  EXPECT_TRUE(WaitUntil([this] { return counters().connections == 0; }));
}

TEST_F(HttpServiceTest, AnswersAClientThatHasClosedItsHalf) {
  Start();
  Wire wire(port(), kGet);
  wire.socket().CloseHalf();
  EXPECT_TRUE(wire.WaitForEnd());
  EXPECT_NE(wire.received().find("hello /"), std::string::npos);
}

TEST_F(HttpServiceTest, LetsGoOfClientsThatLeaveInTheMiddle) {
  Start();
  for (const char* request : {"", "GET / HT", kGet, kFollow}) {
    Wire half(port(), request);
    half.socket().CloseHalf();
    EXPECT_TRUE(half.WaitForEnd());
    Wire(port(), request).socket().Reset();
  }
  EXPECT_TRUE(WaitUntil([this] { return counters().connections == 0; }));
  EXPECT_EQ(counters().viewers, 0);
  EXPECT_TRUE(Works());
}

TEST_F(HttpServiceTest, DropsClientsThatTakeTooLongOverARequest) {
  ViewServerOptions options = QuickOptions();
  options.request_timeout = 0.1;
  Start(options);
  Wire silent(port());
  EXPECT_TRUE(silent.WaitForEnd());
  // Sending a byte now and then does not extend the time.
  Wire slow(port());
  EXPECT_TRUE(WaitUntil([&] { return !slow.Send("G"); }));
  Wire between(port(), kGet);  // and nothing after it
  EXPECT_TRUE(between.WaitForEnd());
  EXPECT_NE(between.received().find("hello"), std::string::npos);
}

TEST_F(HttpServiceTest, DropsClientsThatDoNotTakeTheirReply) {
  ViewServerOptions options = QuickOptions();
  options.write_timeout = 0.1;
  Start(options);
  Wire lazy(port(), "GET /large HTTP/1.1\r\n\r\n");
  EXPECT_TRUE(
      WaitUntil([this] { return counters().requests == 1 && counters().connections == 0; }));
}

// Whether a client gets a large body completely if it reads slowly but steadily, and so takes
// longer than the write timeout; `request` asks for the body. Also false if this machine was too
// busy for that long.
bool GetsItSlowly(const HttpService& service, const char* request, std::size_t size) {
  constexpr auto kPause = std::chrono::milliseconds(10);
  constexpr auto kDuration = std::chrono::milliseconds(800);
  Wire wire(service.port(), request, 64 * 1024);
  const std::size_t pieces = kDuration / kPause;
  for (std::size_t piece = 1; piece <= pieces; ++piece) {
    if (!wire.WaitForBytes(size * piece / pieces)) return false;
    std::this_thread::sleep_for(kPause);
  }
  return true;
}

TEST_F(HttpServiceTest, LetsClientsTakeTheirTimeWhileTheyTakeSomething) {
  ViewServerOptions options = QuickOptions();
  options.write_timeout = 0.4;
  Start(options);
  for (const char* request :
       {"GET /large HTTP/1.1\r\n\r\n", "GET /long-snapshot HTTP/1.1\r\n\r\n"}) {
    bool done = false;
    for (int attempt = 0; attempt < 10 && !done; ++attempt) {
      done = GetsItSlowly(*service_, request, 20'000'000);
    }
    EXPECT_TRUE(done) << request;
  }
}

TEST_F(HttpServiceTest, TurnsAwayMoreConnectionsThanItTakes) {
  constexpr rlim_t kDescriptors = 3000;
  rlimit limit = {};
  getrlimit(RLIMIT_NOFILE, &limit);
  if (limit.rlim_cur < kDescriptors) {
    if (limit.rlim_max < kDescriptors) GTEST_SKIP() << "too few descriptors for 2,000 connections";
    limit.rlim_cur = kDescriptors;
    setrlimit(RLIMIT_NOFILE, &limit);
  }
  ViewServerOptions options = QuickOptions();
  options.request_timeout = 600.0;
  Start(options);
  {
    std::vector<Wire> crowd;
    for (int i = 0; i < 2000; ++i) crowd.emplace_back(port());
    ASSERT_TRUE(
        WaitUntil([&] { return counters().turned_away == 2000 - options.max_connections; }));
    EXPECT_EQ(counters().connections, options.max_connections);
    EXPECT_TRUE(crowd.back().WaitForEnd());
    crowd.front().Send(kGet);
    EXPECT_TRUE(crowd.front().WaitFor("hello")) << "those who came first are served";
  }
  EXPECT_TRUE(WaitUntil([this] { return counters().connections == 0; }));
  EXPECT_TRUE(Works());
}

TEST_F(HttpServiceTest, SendsViewersASnapshotAndThenAllNews) {
  Start();
  content_.Tell("before;");
  Wire early(port(), kFollow);
  ASSERT_TRUE(early.WaitFor("snapshot after"));
  ASSERT_TRUE(WaitUntil([this] { return counters().viewers == 1; }));
  std::string all;
  for (int i = 0; i < 50; ++i) {
    all += "news " + std::to_string(i) + ";";
    content_.Tell("news " + std::to_string(i) + ";");
  }
  EXPECT_TRUE(early.WaitFor("news 49;"));
  EXPECT_NE(early.received().find(all), std::string::npos) << "there is a gap";
  EXPECT_EQ(counters().skips, 0);
}

TEST_F(HttpServiceTest, SkipsViewersAheadThatDoNotKeepUpAndNobodyElse) {
  ViewServerOptions options = QuickOptions();
  options.max_backlog = 100'000;
  Start(options);
  Wire slow(port(), kFollow);
  Wire quick(port(), kFollow);
  ASSERT_TRUE(quick.WaitFor("snapshot"));
  ASSERT_TRUE(WaitUntil([this] { return counters().viewers == 2; }));
  std::size_t told = 0;
  for (int i = 0; counters().skips == 0; ++i) {  // until the system's buffers are full as well
    ASSERT_LT(i, 2000) << "nothing was skipped in 100 MB";
    const std::string news(50'000, static_cast<char>('a' + i % 26));
    told += news.size() + 1;
    content_.Tell(news + ";");
    ASSERT_TRUE(quick.WaitFor(";"));
    ASSERT_TRUE(quick.WaitFor(news + ";"));
    quick.Forget();
  }
  EXPECT_TRUE(slow.WaitFor("snapshot after " + std::to_string(told) + ";"));
  content_.Tell("both again;");
  EXPECT_TRUE(slow.WaitFor("both again;"));
  EXPECT_TRUE(quick.WaitFor("both again;"));
}

TEST_F(HttpServiceTest, DropsViewersThatNeverRead) {
  ViewServerOptions options = QuickOptions();
  options.max_backlog = 100'000;
  options.write_timeout = 0.1;
  Start(options);
  Wire deaf(port(), kFollow);
  ASSERT_TRUE(WaitUntil([this] { return counters().viewers == 1; }));
  EXPECT_TRUE(WaitUntil([this] {
    content_.Tell(std::string(50'000, 'x'));
    return counters().viewers == 0;
  }));
  EXPECT_TRUE(Works());
}

TEST_F(HttpServiceTest, ServesTwentyViewersAtOnce) {
  Start();
  std::vector<Wire> viewers;
  for (int i = 0; i < 20; ++i) viewers.emplace_back(port(), kFollow);
  ASSERT_TRUE(WaitUntil([this] { return counters().viewers == 20; }));
  content_.Tell("for all;");
  for (Wire& viewer : viewers) EXPECT_TRUE(viewer.WaitFor("for all;"));
}

TEST_F(HttpServiceTest, WaitsUntilAllIsSent) {
  Start();
  Wire viewer(port(), kFollow);
  ASSERT_TRUE(WaitUntil([this] { return counters().viewers == 1; }));
  content_.Tell("the last;");
  service_->WaitUntilSent(60.0);
  service_.reset();
  EXPECT_TRUE(viewer.WaitForEnd());
  EXPECT_NE(viewer.received().find("the last;"), std::string::npos);
}

TEST_F(HttpServiceTest, EndsWhileClientsAreThere) {
  Start();
  Wire idle(port());
  Wire half(port(), "GET / HT");
  Wire viewer(port(), kFollow);
  Wire lazy(port(), "GET /large HTTP/1.1\r\n\r\n");
  ASSERT_TRUE(viewer.WaitFor("snapshot"));
  service_.reset();
  EXPECT_TRUE(idle.WaitForEnd());
  EXPECT_TRUE(half.WaitForEnd());
  EXPECT_TRUE(viewer.WaitForEnd());
}

TEST_F(HttpServiceTest, SaysWhereItIs) {
  Start();
  EXPECT_GT(port(), 0);
  EXPECT_EQ(service_->url(), "http://127.0.0.1:" + std::to_string(port()) + "/");
  EXPECT_TRUE(service_->is_loopback());
  ViewServerOptions options;
  options.host = "0.0.0.0";
  EXPECT_FALSE(HttpService(options).is_loopback());
}

TEST_F(HttpServiceTest, RefusesAnAddressThatIsTaken) {
  Start();
  ViewServerOptions options;
  options.port = port();
  try {
    HttpService second(options);
    FAIL() << "bound twice";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInput);
    EXPECT_EQ(std::string(error.what()).find("127.0.0.1:" + std::to_string(port()) + ": "), 0u);
  }
}

}  // namespace
}  // namespace loopgrid
