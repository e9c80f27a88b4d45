#include "apps/view/view_server.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/apps/online/wait_until.h"
#include "tests/apps/view/round_trip.h"
#include "tests/apps/view/wire.h"
#include "tests/support/http_client.h"

namespace loopgrid {
namespace {

using test_support::AskOnce;
using test_support::RoundTrip;
using test_support::WaitUntil;
using test_support::Wire;

constexpr const char* kFollowServer = "GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n";

ViewServerOptions QuickServerOptions() {
  ViewServerOptions options;
  options.batch_interval = 0.002;
  return options;
}

class ViewServerTest : public testing::Test {
 protected:
  LiveMap map_;
  PublishedFiles files_;
  ViewServer server_{QuickServerOptions(), &map_, &files_};
};

TEST_F(ViewServerTest, ServesPageFilesAndTiles) {
  const RoundTrip trip(3);
  map_.Add(trip.Update(0));
  map_.WaitUntilCurrent();
  files_.Put("map.png", std::make_shared<const std::string>(EncodePng(map_.Picture().image)));
  const auto page = AskOnce(server_.port(), {});
  EXPECT_EQ(page.status, 200);
  EXPECT_NE(page.body.find("<canvas"), std::string::npos);
  EXPECT_EQ(AskOnce(server_.port(), {.target = "/map.png"}).body, *files_.Get("map.png"));
  EXPECT_EQ(AskOnce(server_.port(), {.target = "/map.yaml"}).status, 503);
  EXPECT_EQ(AskOnce(server_.port(), {.target = "/tiles/0/0/0.png"}).body,
            *map_.tiles().Png({0, 0, 0}));
  EXPECT_EQ(AskOnce(server_.port(), {.method = "POST", .body = "x"}).status, 405);
  EXPECT_EQ(AskOnce(server_.port(), {.headers = {{"Host", "evil.example"}}}).status, 403);
}

TEST(ViewServerAddress, AnswersUnderTheAddressThatItAnnounces) {
  const LiveMap map;
  const PublishedFiles files;
  for (const char* host : {"127.0.0.2", "localhost"}) {
    ViewServerOptions options = QuickServerOptions();
    options.host = host;
    const ViewServer server(options, &map, &files);
    std::string announced = server.url();
    ASSERT_TRUE(announced.starts_with("http://") && announced.ends_with("/")) << announced;
    announced = announced.substr(7, announced.size() - 8);
    if (announced.starts_with('[')) continue;  // the client of these tests speaks IPv4 only
    const std::string address = announced.substr(0, announced.find(':'));
    const auto status_for = [&](const std::string& name) {
      return test_support::HttpClient(server.port(), address)
          .Ask({.headers = {{"Host", name}}})
          .status;
    };
    EXPECT_EQ(status_for(announced), 200);
    EXPECT_EQ(status_for(std::string(host) + ":80"), 200);
    EXPECT_EQ(status_for("evil.example"), 403);
  }
}

TEST_F(ViewServerTest, TellsViewersWhatHappens) {
  RoundTrip trip(9);
  Wire viewer(server_.port(), kFollowServer);
  ASSERT_TRUE(viewer.WaitFor("event: state\n"));
  ASSERT_TRUE(viewer.WaitFor("\n\n"));
  ASSERT_TRUE(WaitUntil([this] { return server_.counters().viewers == 1; }));
  OnlineUpdate update = trip.UpdateWithNodes(6);
  Closure record;
  record.outcome = ClosureOutcome::kAmbiguous;
  update.closures = {record};
  map_.Add(update);
  server_.Add(update);
  EXPECT_TRUE(viewer.WaitFor("event: poses\n"));
  EXPECT_TRUE(viewer.WaitFor("event: nodes\n"));
  EXPECT_TRUE(viewer.WaitFor("a second place fits nearly as well"));
  EXPECT_TRUE(viewer.WaitFor("event: tiles\n"));
  EXPECT_EQ(viewer.received().find("event: end"), std::string::npos);
}

TEST_F(ViewServerTest, ServesTwentyViewersWhileTheMapGrows) {
  RoundTrip trip(120);
  std::vector<Wire> viewers;
  for (int i = 0; i < 20; ++i) viewers.emplace_back(server_.port(), kFollowServer);
  std::thread mapping([&] {
    for (int scan = 0; scan < trip.scans(); ++scan) {
      if (scan % 30 == 29) trip.MoveNodes(SE2(0.001 * scan, 0.0, 0.0));
      const OnlineUpdate update = scan % 30 == 29 ? trip.UpdateWithNodes(scan) : trip.Update(scan);
      map_.Add(update);
      server_.Add(update);
    }
  });
  for (Wire& viewer : viewers) EXPECT_TRUE(viewer.WaitFor("\"scan\":119,"));
  mapping.join();
}

TEST_F(ViewServerTest, SaysThatItIsOverToThoseWhoAreThereAndThoseWhoCome) {
  const RoundTrip trip(3);
  Wire early(server_.port(), kFollowServer);
  ASSERT_TRUE(WaitUntil([this] { return server_.counters().viewers == 1; }));
  server_.Add(trip.Update(0));
  server_.Finish();
  EXPECT_TRUE(early.WaitFor("event: end\n"));
  EXPECT_LT(early.received().find("\"scan\":0,"), early.received().find("event: end\n"));
  Wire late(server_.port(), kFollowServer);
  EXPECT_TRUE(late.WaitFor("\"ended\":true"));
}

TEST_F(ViewServerTest, GivesEachRunAnotherName) {
  ViewServer other(QuickServerOptions(), &map_, &files_);
  Wire a(server_.port(), kFollowServer);
  Wire b(other.port(), kFollowServer);
  ASSERT_TRUE(a.WaitFor("\"resolution\""));
  ASSERT_TRUE(b.WaitFor("\"resolution\""));
  const auto run = [](const Wire& wire) {
    return wire.received().substr(wire.received().find("\"run\""), 25);
  };
  EXPECT_NE(run(a), run(b));
}

}  // namespace
}  // namespace loopgrid
