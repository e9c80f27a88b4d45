#include "apps/view/view_routes.h"

#include <gtest/gtest.h>

#include "apps/view/view_page.h"

namespace loopgrid {
namespace {

constexpr const char* kHost = "localhost:8080";

std::string HeaderOf(const Reply& reply, const std::string& name) {
  for (const auto& [key, value] : reply.headers) {
    if (key == name) return value;
  }
  return "";
}

class ViewRoutesTest : public testing::Test {
 protected:
  ViewRoutesTest() {
    OccupancyGrid grid;
    const Eigen::Vector2f hit(1.0f, 1.0f);
    grid.AddScan(SE2(), {.origin = {0.0, 0.0}, .hits = {&hit, 1}, .no_returns = {}});
    tiles_.Update(grid, grid.SeenBox());
  }

  Reply Get(std::string_view target, std::string_view if_none_match = "") const {
    return routes_.Answer({"GET", target, kHost, if_none_match});
  }
  int StatusFor(std::string_view host) const {
    return routes_.Answer({"GET", "/", host, ""}).status;
  }

  MapTiles tiles_;
  PublishedFiles files_;
  ViewRoutes routes_{"run", HostCheck(true, "127.0.0.1"), &tiles_, &files_};
};

TEST_F(ViewRoutesTest, HaveThePageWithAPolicyThatAllowsNothingFromElsewhere) {
  const Reply reply = Get("/");
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.type, "text/html; charset=utf-8");
  EXPECT_EQ(*reply.body, ViewPage());
  EXPECT_NE(reply.body->find("<canvas"), std::string::npos);
  EXPECT_EQ(reply.body->find("/*SCRIPT*/"), std::string::npos);
  const std::string policy = HeaderOf(reply, "Content-Security-Policy");
  EXPECT_EQ(policy.find("default-src 'self'"), 0u);
  EXPECT_EQ(policy.find("unsafe"), std::string::npos);
  EXPECT_EQ(HeaderOf(reply, "X-Content-Type-Options"), "nosniff");
  for (const char* elsewhere : {"src=\"http", "src='http", "url(http", "@import", "fetch('http"}) {
    EXPECT_EQ(reply.body->find(elsewhere), std::string::npos) << elsewhere;
  }
}

TEST_F(ViewRoutesTest, HaveEachFileOnceItIsThere) {
  const std::vector<std::pair<std::string, std::string>> files = {
      {"map.png", "image/png"},
      {"map.pgm", "image/x-portable-graymap"},
      {"map.yaml", "application/yaml"},
      {"graph.g2o", "text/plain; charset=utf-8"},
      {"trajectory.tum", "text/plain; charset=utf-8"},
      {"status.json", "application/json"}};
  for (const auto& [name, type] : files) {
    const Reply missing = Get("/" + name);
    EXPECT_EQ(missing.status, 503) << name;
    EXPECT_EQ(HeaderOf(missing, "Retry-After"), "1");
    files_.Put(name, std::make_shared<const std::string>("content of " + name));
    const Reply reply = Get("/" + name);
    EXPECT_EQ(reply.status, 200) << name;
    EXPECT_EQ(reply.type, type);
    EXPECT_EQ(*reply.body, "content of " + name);
    EXPECT_EQ(HeaderOf(reply, "Cache-Control"), "no-store");
  }
}

TEST_F(ViewRoutesTest, HaveNoOtherFilesOfTheFolder) {
  files_.Put("secret", std::make_shared<const std::string>("x"));
  for (const char* target :
       {"/secret", "/../etc/passwd", "/map.png/", "//map.png", "map.png", "xmap.png", "", "*",
        "/%2e%2e/map.png", "/tiles", "/Map.png", "/favicon.ico"}) {
    EXPECT_EQ(Get(target).status, 404) << target;
  }
}

TEST_F(ViewRoutesTest, KnowOnlyReading) {
  for (const char* method : {"POST", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "get", "BREW"}) {
    const Reply reply = routes_.Answer({method, "/", kHost, ""});
    EXPECT_EQ(reply.status, 405) << method;
    EXPECT_EQ(HeaderOf(reply, "Allow"), "GET, HEAD");
  }
  EXPECT_EQ(routes_.Answer({"HEAD", "/", kHost, ""}).status, 200);
}

TEST_F(ViewRoutesTest, HaveTilesThatNeedNotBeAskedForTwice) {
  const Reply reply = Get("/tiles/0/0/0.png");
  ASSERT_EQ(reply.status, 200);
  EXPECT_EQ(reply.type, "image/png");
  EXPECT_EQ(reply.body->substr(1, 3), "PNG");
  EXPECT_EQ(HeaderOf(reply, "Cache-Control"), "no-cache");
  const std::string tag = HeaderOf(reply, "ETag");
  const Reply unchanged = Get("/tiles/0/0/0.png", tag);
  EXPECT_EQ(unchanged.status, 304);
  EXPECT_EQ(unchanged.body, nullptr);
  EXPECT_EQ(Get("/tiles/0/0/0.png", "\"other\"").status, 200);

  const std::string version = tag.substr(1, tag.size() - 2);
  const auto cache_control = [&](const std::string& asked) {
    return HeaderOf(Get("/tiles/0/0/0.png?v=" + asked), "Cache-Control");
  };
  EXPECT_NE(cache_control(version).find("immutable"), std::string::npos);
  EXPECT_EQ(cache_control("run.999"), "no-cache");
  EXPECT_EQ(cache_control("otherrun" + version.substr(3)), "no-cache");
}

TEST_F(ViewRoutesTest, HaveNoTilesUnderNonsense) {
  for (const char* target :
       {"/tiles/0/0/1.png", "/tiles/0/0/0", "/tiles/0/0/0.jpg", "/tiles/9/0/0.png",
        "/tiles/-1/0/0.png", "/tiles///.png", "/tiles/0/0/.png", "/tiles/0/0.png",
        "/tiles/0/0/0/0.png", "/tiles/0/99999999999/0.png", "/tiles/a/b/c.png", "/tiles/"}) {
    EXPECT_EQ(Get(target).status, 404) << target;
  }
}

TEST_F(ViewRoutesTest, AnswerOnlyToHostsThatTheCheckAccepts) {
  for (const char* host : {"localhost:8080", "127.0.0.2:8080"}) {
    EXPECT_EQ(StatusFor(host), 200) << host;
  }
  for (const char* host : {"", "evil.example:8080"}) EXPECT_EQ(StatusFor(host), 403) << host;
  const ViewRoutes open("run", HostCheck(false, "0.0.0.0"), &tiles_, &files_);
  EXPECT_EQ(open.Answer({"GET", "/", "robot.example", ""}).status, 200);
}

TEST_F(ViewRoutesTest, LeadToTheEvents) {
  const Reply reply = Get("/events?x=1");
  EXPECT_TRUE(reply.follows_events);
  EXPECT_EQ(reply.type, "text/event-stream");
}

}  // namespace
}  // namespace loopgrid
