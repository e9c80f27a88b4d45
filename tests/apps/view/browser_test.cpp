// The page in a real browser. Screenshots go to the folder of the build.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <set>
#include <string>
#include <thread>

#include "apps/view/view_server.h"
#include "tests/apps/online/wait_until.h"
#include "tests/apps/view/round_trip.h"
#include "tests/support/browser.h"

namespace loopgrid {
namespace {

using nlohmann::json;
using test_support::Browser;
using test_support::RoundTrip;

// Of the WebDriver protocol.
const std::string kArrowLeft = "\uE012";
const std::string kArrowUp = "\uE013";
const std::string kEscape = "\uE00C";

// How many pixels of the canvas have the colour `name` of the style sheet.
std::string PixelsOf(const std::string& name) {
  return "(() => {"
         "const view = document.getElementById('view');"
         "const color = getComputedStyle(document.documentElement).getPropertyValue('--" +
         name +
         "').trim();"
         "const wanted = [1, 3, 5].map((i) => parseInt(color.slice(i, i + 2), 16));"
         "const copy = new OffscreenCanvas(view.width, view.height);"
         "const context = copy.getContext('2d', {willReadFrequently: true});"
         "context.drawImage(view, 0, 0);"
         "const {data} = context.getImageData(0, 0, view.width, view.height);"
         "let count = 0;"
         "for (let i = 0; i < data.length; i += 4) {"
         "  if (wanted.every((value, j) => data[i + j] === value)) ++count;"
         "}"
         "return count;"
         "})()";
}

/// A mapping run with its page in the browser. All tests share one browser, because it starts
/// slowly.
class BrowserTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (Browser::IsInstalled()) browser_ = new Browser;
  }
  static void TearDownTestSuite() {
    delete browser_;
    browser_ = nullptr;
  }

  void SetUp() override {
    if (browser_ == nullptr) {
      GTEST_SKIP() << "NOT TESTED: the page, for chromium or chromedriver is not installed";
    }
    browser().Resize(1280, 800);
    browser().PreferDark(false);
    Serve();
    browser().Open("about:blank");
    browser().TakeComplaints();
    browser().TakeHosts();
    browser().Open(server_->url());
    ASSERT_TRUE(browser().WaitFor("window.loopgrid && loopgrid.frames > 0"));
    ASSERT_TRUE(browser().WaitFor("document.getElementById('state').dataset.state === 'live'"));
  }

  void TearDown() override {
    if (browser_ == nullptr || server_ == nullptr) return;
    if (HasFailure()) Screenshot(testing::UnitTest::GetInstance()->current_test_info()->name());
    for (const std::string& complaint : browser().TakeComplaints()) {
      const bool is_expected = may_lose_server_ && complaint.find("ERR_") != std::string::npos;
      EXPECT_TRUE(is_expected) << complaint;
    }
    for (const std::string& host : browser().TakeHosts()) {
      EXPECT_EQ(host, fmt::format("127.0.0.1:{}", port_));
    }
    browser().Open("about:blank");
  }

  static Browser& browser() { return *browser_; }

  // Starts a new server, on the same port if there was one before.
  void Serve() {
    server_.reset();
    map_ = std::make_unique<LiveMap>();
    ViewServerOptions options;
    options.port = port_;
    server_ = std::make_unique<ViewServer>(options, map_.get(), &files_);
    port_ = server_->port();
  }

  void Add(const OnlineUpdate& update) {
    map_->Add(update);
    server_->Add(update);
  }

  void AddScans(int first, int last) {
    for (int scan = first; scan < last; ++scan) Add(trip_.Update(scan));
  }

  bool WaitForScan(int scan) {
    return browser().WaitFor(fmt::format("loopgrid.world.pose?.scan === {}", scan)) &&
           browser().WaitFor(
               fmt::format("document.getElementById('scans').textContent === '{}'", scan + 1));
  }

  static OnlineUpdate WithClosure(OnlineUpdate update, int from, int to, ClosureOutcome outcome) {
    Closure record;
    record.id = to;  // one closure a node
    record.from = from;
    record.to = to;
    record.outcome = outcome;
    record.score = 0.83;
    record.T_from_to = SE2(1.5, 0.0, 0.1);
    update.closures.push_back(record);
    return update;
  }

  static std::string Attribute(const std::string& id, const std::string& name) {
    return browser().Run(
        fmt::format("return document.getElementById('{}').getAttribute('{}')", id, name));
  }

  static double Number(const std::string& expression) {
    return browser().Run("return " + expression).get<double>();
  }

  // The dialog takes all keys until it is closed.
  static bool LeavesHelp() {
    browser().Press({kEscape});
    return browser().WaitFor("!document.getElementById('help-dialog').open");
  }

  // Whether the page stops drawing: no frame in half a second.
  static bool ComesToRest() {
    return test_support::WaitUntil([] {
      const double frames = Number("loopgrid.frames");
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
      return Number("loopgrid.frames") == frames;
    });
  }

  static void Screenshot(const std::string& name) {
    browser().SaveScreenshot(fmt::format("{}/{}.png", LOOPGRID_SCREENSHOTS, name));
  }

  static Browser* browser_;
  RoundTrip trip_{160};
  PublishedFiles files_;
  std::unique_ptr<LiveMap> map_;
  std::unique_ptr<ViewServer> server_;
  int port_ = 0;
  bool may_lose_server_ = false;
};

Browser* BrowserTest::browser_ = nullptr;

TEST_F(BrowserTest, DrawsTheMapOnAnEmptyPage) {
  EXPECT_EQ(Number(PixelsOf("free")), 0);
  AddScans(0, 30);
  EXPECT_TRUE(browser().WaitFor(PixelsOf("free") + " > 10000"));
  EXPECT_TRUE(browser().WaitFor(PixelsOf("wall") + " > 100"));
}

TEST_F(BrowserTest, HasAFirstPictureSoonAfterItIsOpened) {
  AddScans(0, 60);
  map_->WaitUntilCurrent();
  browser().Open(server_->url() + "?again");
  ASSERT_TRUE(browser().WaitFor("window.loopgrid?.firstPicture"));
  std::printf("first picture after %.0f ms\n", Number("loopgrid.firstPicture"));
}

TEST_F(BrowserTest, FollowsAStreamOfScans) {
  std::thread robot([this] {
    for (int scan = 0; scan < trip_.scans(); ++scan) {
      if (scan % 40 == 39) trip_.MoveNodes(SE2(0.0005 * scan, 0.0, 1e-4));
      Add(scan % 40 == 39 ? trip_.UpdateWithNodes(scan) : trip_.Update(scan));
      std::this_thread::sleep_for(std::chrono::milliseconds(15));  // about 20 times Intel's pace
    }
  });
  const bool arrived = WaitForScan(159);
  robot.join();
  EXPECT_TRUE(arrived);
  std::printf("%.0f frames a second while scans come in\n", Number("loopgrid.fps"));
  EXPECT_EQ(Number("loopgrid.world.nodes.length"), 54);
  EXPECT_TRUE(browser().WaitFor(PixelsOf("path") + " > 50"));
  Screenshot("desktop");
}

TEST_F(BrowserTest, ShowsClosuresWithTheirReasons) {
  AddScans(0, 120);
  Add(WithClosure(trip_.Update(120), 3, 30, ClosureOutcome::kAccepted));
  Add(WithClosure(trip_.Update(121), 4, 31, ClosureOutcome::kAmbiguous));
  const std::string item = "document.querySelector('#closures [data-outcome={}]')?.textContent";
  EXPECT_TRUE(
      browser().WaitFor(fmt::format(fmt::runtime(item + ".includes('30 → 3')"), "accepted")));
  EXPECT_TRUE(browser().WaitFor(fmt::format(
      fmt::runtime(item + ".includes('a second place fits nearly as well')"), "refused")));
  EXPECT_TRUE(browser().WaitFor("document.getElementById('accepted').textContent === '1'"));
  EXPECT_TRUE(browser().WaitFor("document.getElementById('refused').textContent === '1'"));
  browser().Click("#closures [data-outcome=accepted] button");
  EXPECT_TRUE(browser().WaitFor(PixelsOf("closed") + " > 20"));
  Screenshot("closure");
}

TEST_F(BrowserTest, PausesThePictureButKeepsReceiving) {
  AddScans(0, 30);
  ASSERT_TRUE(WaitForScan(29));
  browser().Press({" "});
  ASSERT_EQ(Attribute("pause", "aria-pressed"), "true");
  AddScans(30, 90);
  ASSERT_TRUE(browser().WaitFor("loopgrid.live.pose.scan === 89"));
  ASSERT_TRUE(ComesToRest());
  EXPECT_EQ(Number("loopgrid.world.pose.scan"), 29);
  EXPECT_EQ(browser().Run("return document.getElementById('scans').textContent"), "30");
  browser().Press({" "});
  EXPECT_EQ(Attribute("pause", "aria-pressed"), "false");
  EXPECT_TRUE(WaitForScan(89));
}

TEST_F(BrowserTest, ObeysTheKeyboard) {
  AddScans(0, 30);
  ASSERT_TRUE(WaitForScan(29));
  const double x = Number("loopgrid.camera.x");
  browser().Press({kArrowLeft, kArrowUp});
  EXPECT_LT(Number("loopgrid.camera.x"), x);
  EXPECT_EQ(Attribute("fit", "aria-pressed"), "false");
  const double scale = Number("loopgrid.camera.scale");
  browser().Press({"+", "+"});
  EXPECT_GT(Number("loopgrid.camera.scale"), scale);
  browser().Press({"-", "-"});
  EXPECT_NEAR(Number("loopgrid.camera.scale"), scale, 1e-6);
  browser().Press({"f"});
  EXPECT_EQ(Attribute("follow", "aria-pressed"), "true");
  browser().Press({"0"});
  EXPECT_EQ(Attribute("fit", "aria-pressed"), "true");
  browser().Press({"e"});
  EXPECT_EQ(Attribute("ellipses", "aria-pressed"), "true");
  browser().Press({"?"});
  EXPECT_TRUE(browser().WaitFor("document.getElementById('help-dialog').open"));
  Screenshot("help");
  EXPECT_TRUE(LeavesHelp());
}

TEST_F(BrowserTest, LeavesSingleKeysAloneWhenTheyAreSwitchedOffAndRemembersIt) {
  browser().Press({"?"});
  browser().Click("#single-keys");
  ASSERT_TRUE(LeavesHelp());
  browser().Press({"f", "e", " "});
  for (int visit = 0; visit < 2; ++visit) {
    for (const char* button : {"follow", "ellipses", "pause"}) {
      EXPECT_EQ(Attribute(button, "aria-pressed"), "false") << button;
    }
    const double x = Number("loopgrid.camera.x");
    browser().Press({kArrowLeft});
    EXPECT_LT(Number("loopgrid.camera.x"), x) << "arrow keys are no single keys";
    browser().Open(server_->url() + "?again");
    ASSERT_TRUE(browser().WaitFor("window.loopgrid && loopgrid.frames > 0"));
    browser().Press({"f", "e", " "});
  }
  browser().Click("#help");
  browser().Click("#single-keys");
  ASSERT_TRUE(LeavesHelp());
  browser().Press({"f"});
  EXPECT_EQ(Attribute("follow", "aria-pressed"), "true");
}

TEST_F(BrowserTest, ShowsHowFarTheRobotHasTravelled) {
  AddScans(0, 30);
  ASSERT_TRUE(WaitForScan(29));
  // 29 sides of a polygon with 24 corners, 1.9 m from its middle; every third corner is a node.
  EXPECT_EQ(browser().Run("return document.getElementById('travelled').textContent"), "14.4 m");
}

TEST_F(BrowserTest, RestsWhileNothingChanges) {
  AddScans(0, 30);
  ASSERT_TRUE(WaitForScan(29));
  EXPECT_TRUE(ComesToRest());
  AddScans(30, 31);
  EXPECT_TRUE(WaitForScan(30)) << "it does not wake up";
  EXPECT_TRUE(ComesToRest());
}

TEST_F(BrowserTest, AsksForNothingAfterTheEnd) {
  AddScans(0, 60);
  ASSERT_TRUE(WaitForScan(59));
  server_->Finish();
  ASSERT_TRUE(browser().WaitFor("document.getElementById('state').dataset.state === 'ended'"));
  ASSERT_TRUE(ComesToRest());
  server_.reset();
  EXPECT_GT(Number(PixelsOf("free")), 10000);
  browser().TakeHosts();
  browser().Press({"-", "-", "-", "-", "-", "-"});  // there it would need other tiles
  ASSERT_TRUE(ComesToRest());
  EXPECT_EQ(browser().TakeHosts(), std::set<std::string>());
  EXPECT_GT(Number(PixelsOf("free")), 100) << "the map is drawn from the tiles that are there";
  EXPECT_EQ(Attribute("state", "data-state"), "ended");
}

TEST_F(BrowserTest, FitsAPhone) {
  browser().Resize(390, 844, true);
  browser().PreferDark(true);
  AddScans(0, 120);
  Add(WithClosure(trip_.Update(120), 3, 30, ClosureOutcome::kAccepted));
  ASSERT_TRUE(WaitForScan(120));
  EXPECT_EQ(Number("document.documentElement.scrollWidth"), 390);
  const json outside = browser().Run(
      "return [...document.querySelectorAll('button, p, dd')].filter((element) => {"
      "  const {left, right, width} = element.getBoundingClientRect();"
      "  return width > 0 && (left < 0 || right > 390);"
      "}).map((element) => element.id)");
  EXPECT_EQ(outside, json::array());
  const json small = browser().Run(
      "return [...document.querySelectorAll('#tools button, #panel-toggle')].filter((element) => {"
      "  const {width, height} = element.getBoundingClientRect();"
      "  return width < 40 || height < 44;"
      "}).map((element) => element.id)");
  EXPECT_EQ(small, json::array()) << "too small for a finger";
  ASSERT_TRUE(browser().WaitFor(PixelsOf("free") + " > 1000"));
  Screenshot("phone");
  browser().Click("#panel-toggle");
  EXPECT_TRUE(browser().WaitFor("document.querySelector('#closures li').offsetHeight > 0"));
  EXPECT_EQ(Number("document.documentElement.scrollWidth"), 390);
  Screenshot("phone-closures");
}

TEST_F(BrowserTest, SurvivesTheServerGoingAwayAndComingBack) {
  may_lose_server_ = true;
  AddScans(0, 60);
  ASSERT_TRUE(WaitForScan(59));
  server_.reset();
  EXPECT_TRUE(
      browser().WaitFor("document.getElementById('state').dataset.state === 'reconnecting'"));
  EXPECT_EQ(Number("loopgrid.world.pose.scan"), 59) << "the last picture stays";
  Serve();
  AddScans(0, 15);
  EXPECT_TRUE(browser().WaitFor("document.getElementById('state').dataset.state === 'live'"));
  EXPECT_TRUE(WaitForScan(14)) << "nothing of the old run is left";
  EXPECT_EQ(Number("loopgrid.world.nodes.length"), 5);
  EXPECT_TRUE(browser().WaitFor(PixelsOf("free") + " > 1000"));
}

TEST_F(BrowserTest, SaysWhenTheRobotIsLostAndWhenTheLogIsOver) {
  AddScans(0, 3);
  OnlineUpdate lost = trip_.Update(3);
  lost.tracked.localized = false;
  Add(lost);
  EXPECT_TRUE(browser().WaitFor(
      "document.getElementById('state').textContent === 'Looking for itself in the map'"));
  Add(trip_.Update(4));
  EXPECT_TRUE(browser().WaitFor("document.getElementById('state').textContent === 'Live'"));
  server_->Finish();
  EXPECT_TRUE(browser().WaitFor("document.getElementById('state').dataset.state === 'ended'"));
}

}  // namespace
}  // namespace loopgrid
