#include "apps/live/refresher.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>

#include "backend/base/error.h"
#include "mapping/map_files.h"
#include "tests/apps/online/wait_until.h"
#include "tests/apps/view/round_trip.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid {
namespace {

using test_support::ReadFile;
using test_support::RoundTrip;
using test_support::TemporaryDirectory;
using test_support::WaitUntil;
using ::testing::HasSubstr;

RefreshContent ContentOf(const RoundTrip& trip) {
  RefreshContent content;
  for (int scan = 0; scan < trip.scans(); ++scan) {
    content.trajectory.push_back({0.2 * scan, trip.Pose(scan)});
    if (scan % RoundTrip::kScansANode == 0) content.graph.poses.push_back(trip.Pose(scan));
  }
  return content;
}

/// A scan whose only wall is `metres` away.
OnlineUpdate FarWall(float metres) {
  auto points = std::make_shared<PointScan>();
  points->hits = {{metres, 0.0F}};
  OnlineUpdate update;
  update.place.node = 0;
  update.tracked.node = 0;
  update.tracked.localized = true;
  update.points = std::move(points);
  return update;
}

void RefreshOnce(const RefreshContent& content, Refresher* refresher) {
  refresher->Refresh(content);
  std::optional<std::int64_t> saved;
  ASSERT_TRUE(WaitUntil([&] { return (saved = refresher->TakeSaved()).has_value(); }));
  EXPECT_EQ(*saved, std::ssize(content.trajectory));
}

TEST(Refresher, WritesAndPublishesTheFilesOfTheMoment) {
  const TemporaryDirectory folder;
  const RoundTrip trip(12);
  LiveMap map;
  for (int scan = 0; scan < trip.scans(); ++scan) map.Add(trip.Update(scan));
  PublishedFiles published;
  Refresher refresher(folder.path(), 0.01, &map, &published);
  RefreshOnce(ContentOf(trip), &refresher);
  EXPECT_EQ(ReadFile(folder.File("trajectory.tum")), FormatTum(ContentOf(trip).trajectory));
  EXPECT_EQ(ReadFile(folder.File("map.pgm")), EncodePgm(DrawMap(trip.Map(12))));
  EXPECT_EQ(ReadFile(folder.File("map.png")), EncodePng(DrawMap(trip.Map(12))));
  EXPECT_EQ(ReadFile(folder.File("map.yaml")), MapYaml(trip.Map(12), "map.pgm"));
  EXPECT_EQ(folder.Names().size(), 5u);
  for (const std::string& name : folder.Names()) {
    ASSERT_NE(published.Get(name), nullptr) << name;
    EXPECT_TRUE(*published.Get(name) == ReadFile(folder.File(name))) << name;
  }
  EXPECT_EQ(refresher.TakeNote(), std::nullopt);
}

TEST(Refresher, DrawsAMapCoarserThatIsTooLargeForAnImage) {
  const TemporaryDirectory folder;
  LiveMapOptions options;
  options.grid.resolution = 0.001;
  LiveMap map(options);
  map.Add(FarWall(40.0F));  // 40,001 cells
  Refresher refresher(folder.path(), 0.01, &map, nullptr);
  RefreshContent content;
  content.trajectory = {{1.0, SE2()}};
  content.graph.poses = {SE2()};
  RefreshOnce(content, &refresher);
  EXPECT_TRUE(ReadFile(folder.File("map.pgm")).starts_with("P5\n20001 1\n"));
  EXPECT_THAT(ReadFile(folder.File("map.yaml")), HasSubstr("resolution: 0.002\n"));
  const std::optional<std::string> note = refresher.TakeNote();
  ASSERT_TRUE(note.has_value());
  EXPECT_THAT(*note, HasSubstr("pixels of 0.002 m"));
  RefreshOnce(content, &refresher);
  EXPECT_EQ(refresher.TakeNote(), std::nullopt) << "it was said already";
}

TEST(Refresher, FolderThatIsGoneIsAnOutputErrorOfIsDue) {
  const TemporaryDirectory folder;
  LiveMap map;
  Refresher refresher(folder.File("gone"), 0.01, &map, nullptr);
  refresher.Refresh({});
  const auto fails = [&] {
    try {
      refresher.IsDue();
      return false;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kOutput);
      EXPECT_THAT(error.what(), HasSubstr("gone/trajectory.tum"));
      return true;
    }
  };
  EXPECT_TRUE(WaitUntil(fails));
}

TEST(Refresher, IsNotDueAgainBeforeTheIntervalIsOver) {
  const TemporaryDirectory folder;
  LiveMap map;
  Refresher refresher(folder.path(), 3600.0, &map, nullptr);
  EXPECT_TRUE(refresher.IsDue());
  RefreshOnce({}, &refresher);
  EXPECT_FALSE(refresher.IsDue());
}

}  // namespace
}  // namespace loopgrid
