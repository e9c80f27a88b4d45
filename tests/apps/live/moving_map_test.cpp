#include "apps/live/moving_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/apps/view/round_trip.h"

namespace loopgrid {
namespace {

using test_support::RoundTrip;

ScanOnMap ScanOf(const OnlineUpdate& update) {
  return {update.place, update.tracked.T_map_robot, update.tracked.localized, update.points};
}

bool SamePicture(const OccupancyGrid& a, const OccupancyGrid& b) {
  return test_support::SameImage(DrawMap(a), DrawMap(b));
}

void DrawAnew(MovingMap* map) {
  map->StartRedraw();
  while (map->IsRedrawing()) map->ContinueRedraw(5);
}

TEST(MovingMap, GrowsScanByScan) {
  const RoundTrip trip(30);
  MovingMap map;
  EXPECT_TRUE(map.TakeChanges().empty());
  for (int scan = 0; scan < trip.scans(); ++scan) map.AddScan(ScanOf(trip.Update(scan)));
  EXPECT_TRUE(SamePicture(map.grid(), trip.Map(30)));
  EXPECT_FALSE(map.IsOutdated());
  EXPECT_TRUE(map.TakeChanges().Contains(map.grid().SeenBox()));
  EXPECT_TRUE(map.TakeChanges().empty());
}

TEST(MovingMap, TakesScansWhileItRedraws) {
  RoundTrip trip(30);
  MovingMap map;
  for (int scan = 0; scan < 12; ++scan) map.AddScan(ScanOf(trip.Update(scan)));
  trip.MoveNodes(SE2(0.05, 0.02, 0.01));
  map.MoveNodes(trip.UpdateWithNodes(12).nodes->poses);
  ASSERT_TRUE(map.IsOutdated());
  map.StartRedraw();
  for (int scan = 12; scan < 20; ++scan) {
    map.ContinueRedraw(1);
    map.AddScan(ScanOf(trip.Update(scan)));
    EXPECT_GT(map.TakeChanges().width(), 0) << "the old picture still grows";
  }
  while (map.IsRedrawing()) map.ContinueRedraw(3);
  for (int scan = 20; scan < 30; ++scan) map.AddScan(ScanOf(trip.Update(scan)));
  EXPECT_TRUE(SamePicture(map.grid(), trip.Map(30)));
  EXPECT_FALSE(map.IsOutdated());
}

TEST(MovingMap, SaysWhenNodesMoveOnDuringARedraw) {
  RoundTrip trip(12);
  MovingMap map;
  for (int scan = 0; scan < 12; ++scan) map.AddScan(ScanOf(trip.Update(scan)));
  trip.MoveNodes(SE2(0.05, 0.0, 0.0));
  map.MoveNodes(trip.UpdateWithNodes(11).nodes->poses);
  map.StartRedraw();
  map.ContinueRedraw(4);
  trip.MoveNodes(SE2(0.3, 0.0, 0.0));
  map.MoveNodes(trip.UpdateWithNodes(11).nodes->poses);
  while (map.IsRedrawing()) map.ContinueRedraw(4);
  EXPECT_TRUE(map.IsOutdated());
  DrawAnew(&map);
  EXPECT_FALSE(map.IsOutdated());
  EXPECT_TRUE(SamePicture(map.grid(), trip.Map(12)));
}

TEST(MovingMap, OverlooksMotionsOfLessThanHalfACellButNotTheirSum) {
  RoundTrip trip(4);
  MovingMap map;
  for (int scan = 0; scan < 4; ++scan) map.AddScan(ScanOf(trip.Update(scan)));
  trip.MoveNodes(SE2(0.02, 0.0, 0.0));
  map.MoveNodes(trip.UpdateWithNodes(3).nodes->poses);
  EXPECT_FALSE(map.IsOutdated());
  trip.MoveNodes(SE2(0.04, 0.0, 0.0));
  map.MoveNodes(trip.UpdateWithNodes(3).nodes->poses);
  EXPECT_TRUE(map.IsOutdated());
}

TEST(MovingMap, NoticesATurnThatShowsFarAway) {
  RoundTrip trip(4);
  MovingMap map;
  for (int scan = 0; scan < 4; ++scan) map.AddScan(ScanOf(trip.Update(scan)));
  trip.MoveNodes(SE2(0.0, 0.0, 0.001));
  map.MoveNodes(trip.UpdateWithNodes(3).nodes->poses);
  EXPECT_FALSE(map.IsOutdated());
  trip.MoveNodes(SE2(0.0, 0.0, 0.01));
  map.MoveNodes(trip.UpdateWithNodes(3).nodes->poses);
  EXPECT_TRUE(map.IsOutdated());
}

TEST(MovingMap, KeepsScansBackUntilTheirSessionHasFoundItself) {
  RoundTrip trip(20);
  MovingMap map;
  for (int scan = 0; scan < 10; ++scan) map.AddScan(ScanOf(trip.Update(scan)));
  for (int scan = 10; scan < 15; ++scan) {
    ScanOnMap lost = ScanOf(trip.Update(scan));
    lost.localized = false;
    map.AddScan(lost);
  }
  EXPECT_TRUE(SamePicture(map.grid(), trip.Map(10)));
  map.AddScan(ScanOf(trip.Update(15)));
  ASSERT_TRUE(map.IsOutdated());
  DrawAnew(&map);
  EXPECT_TRUE(SamePicture(map.grid(), trip.Map(16)));
}

TEST(MovingMap, LeavesOutAndCountsWhatDoesNotFit) {
  const RoundTrip trip(3);
  MovingMap map;
  map.AddScan(ScanOf(trip.Update(0)));
  const GreyImage before = DrawMap(map.grid());
  ScanOnMap far = ScanOf(trip.Update(1));
  far.place = {1, SE2()};
  far.T_map_robot = SE2(1e6, 1e6, 0.0);
  map.AddScan(far);
  far.place = {2, SE2()};
  far.T_map_robot = SE2(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0);
  map.AddScan(far);
  EXPECT_EQ(map.left_out(), 2);
  DrawAnew(&map);
  EXPECT_EQ(map.left_out(), 2);
  EXPECT_TRUE(test_support::SameImage(DrawMap(map.grid()), before));
}

}  // namespace
}  // namespace loopgrid
