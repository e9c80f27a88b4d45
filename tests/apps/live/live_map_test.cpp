#include "apps/live/live_map.h"

#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>
#include <vector>

#include "backend/base/error.h"
#include "tests/apps/view/round_trip.h"

namespace loopgrid {
namespace {

using test_support::RoundTrip;

bool ShowsMapOf(const LiveMap& live, const RoundTrip& trip, int scans) {
  return test_support::SameImage(live.Picture().image, DrawMap(trip.Map(scans)));
}

TEST(LiveMap, ShowsTheSamePictureAsAMapDrawnInOneGo) {
  const RoundTrip trip(40);
  LiveMap live;
  for (int scan = 0; scan < trip.scans(); ++scan) live.Add(trip.Update(scan));
  live.WaitUntilCurrent();
  EXPECT_TRUE(ShowsMapOf(live, trip, 40));
  EXPECT_EQ(MapYaml(live.Picture().box, live.resolution(), "map.pgm"),
            MapYaml(trip.Map(40), "map.pgm"));
  EXPECT_EQ(live.counters().scans, 40);
  EXPECT_EQ(live.counters().waiting, 0u);
  EXPECT_EQ(live.counters().redraws, 0);
}

TEST(LiveMap, FollowsNodesThatMoveAgainAndAgain) {
  RoundTrip trip(60);
  LiveMap live;
  for (int scan = 0; scan < trip.scans(); ++scan) {
    const bool move = scan % 10 == 9;
    if (move) trip.MoveNodes(SE2(0.002 * scan, -0.001 * scan, 1e-4 * scan));
    live.Add(move ? trip.UpdateWithNodes(scan) : trip.Update(scan));
    if (scan % 25 == 24) live.WaitUntilCurrent();
  }
  live.WaitUntilCurrent();
  EXPECT_TRUE(ShowsMapOf(live, trip, 60));
  EXPECT_GE(live.counters().redraws, 2);
}

TEST(LiveMap, IsMovedAsAWholeWithoutANewScan) {
  RoundTrip trip(12);
  LiveMap live;
  for (int scan = 0; scan < trip.scans(); ++scan) live.Add(trip.Update(scan));
  trip.MoveNodes(SE2(0.1, 0.0, 0.02));
  OnlineUpdate moved = trip.UpdateWithNodes(11);
  moved.points = nullptr;
  live.Add(moved);
  live.WaitUntilCurrent();
  EXPECT_TRUE(ShowsMapOf(live, trip, 12));
}

TEST(LiveMap, GetsThereWithoutAnybodyWaitingForIt) {
  RoundTrip trip(12);
  LiveMapOptions options;
  options.publish_interval = 0.01;
  options.redraw_pause = 1.0;
  LiveMap live(options);
  for (int scan = 0; scan < trip.scans(); ++scan) live.Add(trip.Update(scan));
  trip.MoveNodes(SE2(0.1, 0.0, 0.02));
  live.Add(trip.UpdateWithNodes(11));
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (live.counters().redraws < 1 && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::yield();
  }
  EXPECT_EQ(live.counters().redraws, 1);
}

TEST(LiveMap, GivesOnlyChangedTilesNewVersions) {
  const RoundTrip trip(4);
  LiveMap live;
  live.Add(trip.Update(0));
  live.WaitUntilCurrent();
  const std::uint64_t before = live.tiles().version();
  EXPECT_GT(before, 0u);
  live.Add(trip.Update(0));  // nothing new
  live.WaitUntilCurrent();
  EXPECT_EQ(live.tiles().version(), before);
}

TEST(LiveMap, MayBeReadByManyWhileItGrows) {
  RoundTrip trip(40);
  LiveMap live;
  std::atomic<bool> done = false;
  std::vector<std::thread> readers;
  for (int i = 0; i < 3; ++i) {
    readers.emplace_back([&] {
      std::uint64_t known = 0;
      while (!done) {
        for (const TileVersion& tile : live.tiles().ChangedSince(known)) {
          std::uint64_t version = 0;
          EXPECT_NE(live.tiles().Png(tile.id, &version), nullptr);
          EXPECT_GE(version, tile.version);
          known = tile.version;
        }
        live.Picture();
        live.counters();
      }
    });
  }
  for (int scan = 0; scan < trip.scans(); ++scan) {
    if (scan % 10 == 9) trip.MoveNodes(SE2(0.002 * scan, 0.0, 0.0));
    live.Add(scan % 10 == 9 ? trip.UpdateWithNodes(scan) : trip.Update(scan));
  }
  live.WaitUntilCurrent();
  done = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_TRUE(ShowsMapOf(live, trip, 40));
}

TEST(LiveMap, RefusesOptionsOutOfRange) {
  LiveMapOptions options;
  options.redraw_pause = 0.5;
  EXPECT_THROW(LiveMap{options}, Error);
  options = {};
  options.publish_interval = -1.0;
  EXPECT_THROW(LiveMap{options}, Error);
  options = {};
  options.grid.resolution = 0.0;
  EXPECT_THROW(LiveMap{options}, Error);
}

}  // namespace
}  // namespace loopgrid
