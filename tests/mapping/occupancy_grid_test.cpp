#include "mapping/occupancy_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A scan that owns its beams.
struct OwnedScan {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2f> hits;
  std::vector<Eigen::Vector2f> no_returns;

  MapScan View() const { return {origin, hits, no_returns}; }
};

OwnedScan RandomScan(std::mt19937* random) {
  std::uniform_real_distribution<float> coordinate(-3.0F, 3.0F);
  std::uniform_real_distribution<float> angle(-3.0F, 3.0F);
  OwnedScan scan;
  scan.origin = {0.3, -0.1};
  for (int i = 0; i < 20; ++i) scan.hits.emplace_back(coordinate(*random), coordinate(*random));
  for (int i = 0; i < 4; ++i) {
    const float a = angle(*random);
    scan.no_returns.emplace_back(std::cos(a), std::sin(a));
  }
  return scan;
}

SE2 RandomPose(std::mt19937* random) {
  std::uniform_real_distribution<double> coordinate(-2.0, 2.0);
  return {coordinate(*random), coordinate(*random), coordinate(*random)};
}

using CellIndex = std::pair<std::int64_t, std::int64_t>;

CellIndex CellOf(const Eigen::Vector2d& p, double resolution) {
  return {static_cast<std::int64_t>(std::floor(p.x() / resolution)),
          static_cast<std::int64_t>(std::floor(p.y() / resolution))};
}

// The effect of AddScan by another method: beams are sampled in steps much smaller than a cell.
// Within a hundredth of a cell of a boundary both sides are right.
struct NaiveScan {
  std::set<CellIndex> hit;
  std::set<CellIndex> surely_crossed;
  std::set<CellIndex> maybe_crossed;
};

void SampleBeam(const Eigen::Vector2d& start, const Eigen::Vector2d& end, double resolution,
                NaiveScan* naive) {
  constexpr int kSamples = 5000;
  const CellIndex last = CellOf(end, resolution);
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector2d p = start + (end - start) * (static_cast<double>(i) / kSamples);
    std::set<CellIndex> near;
    for (double dx : {-0.02, 0.02}) {
      for (double dy : {-0.02, 0.02}) {
        near.insert(CellOf(p + resolution * Eigen::Vector2d(dx, dy), resolution));
      }
    }
    if (near.size() == 1 && *near.begin() != last) naive->surely_crossed.insert(*near.begin());
    naive->maybe_crossed.insert(near.begin(), near.end());
  }
}

NaiveScan Naive(const SE2& T_map_scan, const OwnedScan& scan, const OccupancyGridOptions& options) {
  NaiveScan naive;
  const Eigen::Vector2d start = T_map_scan * scan.origin;
  for (const Eigen::Vector2f& hit : scan.hits) {
    const Eigen::Vector2d end = T_map_scan * hit.cast<double>();
    naive.hit.insert(CellOf(end, options.resolution));
    SampleBeam(start, end, options.resolution, &naive);
  }
  for (const Eigen::Vector2f& direction : scan.no_returns) {
    const Eigen::Vector2d end = scan.origin + options.no_return_range * direction.cast<double>();
    SampleBeam(start, T_map_scan * end, options.resolution, &naive);
  }
  for (const CellIndex& cell : naive.hit) naive.surely_crossed.erase(cell);
  return naive;
}

void ExpectSameCells(const OccupancyGrid& a, const OccupancyGrid& b) {
  const CellBox box = a.SeenBox().United(b.SeenBox());
  for (std::int64_t y = box.min_y - 1; y <= box.max_y; ++y) {
    for (std::int64_t x = box.min_x - 1; x <= box.max_x; ++x) {
      ASSERT_EQ(a.LogOdds(x, y), b.LogOdds(x, y)) << "cell " << x << ", " << y;
    }
  }
}

TEST(OccupancyGrid, OneBeamClearsItsWayAndHitsItsEnd) {
  OccupancyGrid grid({.resolution = 0.1});
  OwnedScan scan;
  scan.hits = {{0.55F, 0.05F}};
  grid.AddScan(SE2(0.0, 0.05, 0.0), scan.View());
  const OccupancyGridOptions& options = grid.options();
  EXPECT_EQ(grid.LogOdds(5, 1), options.hit_log_odds);
  EXPECT_EQ(grid.State(5, 1), CellState::kWall);
  EXPECT_EQ(grid.State(0, 0), CellState::kFree);
  EXPECT_EQ(grid.LogOdds(0, 0), options.miss_log_odds);
  EXPECT_EQ(grid.State(6, 1), CellState::kUnknown);
  EXPECT_EQ(grid.State(-1, 0), CellState::kUnknown);
}

TEST(OccupancyGrid, AgreesWithDenseSamplingOnRandomScans) {
  std::mt19937 random(11);
  for (int i = 0; i < 10; ++i) {
    OccupancyGrid grid({.resolution = 0.07, .no_return_range = 1.5});
    const OwnedScan scan = RandomScan(&random);
    const SE2 pose = RandomPose(&random);
    grid.AddScan(pose, scan.View());
    const NaiveScan naive = Naive(pose, scan, grid.options());
    const CellBox box = grid.SeenBox();
    std::set<CellIndex> hit;
    std::set<CellIndex> cleared;
    for (std::int64_t y = box.min_y; y < box.max_y; ++y) {
      for (std::int64_t x = box.min_x; x < box.max_x; ++x) {
        if (grid.LogOdds(x, y) == grid.options().hit_log_odds) hit.insert({x, y});
        if (grid.LogOdds(x, y) == grid.options().miss_log_odds) cleared.insert({x, y});
      }
    }
    EXPECT_EQ(hit, naive.hit) << "scan " << i;
    EXPECT_THAT(cleared, testing::IsSupersetOf(naive.surely_crossed)) << "scan " << i;
    EXPECT_THAT(cleared, testing::IsSubsetOf(naive.maybe_crossed)) << "scan " << i;
    EXPECT_GT(naive.surely_crossed.size(), cleared.size() * 9 / 10) << "the oracle is too vague";
  }
}

TEST(OccupancyGrid, HitsOfAScanAreNotClearedByItsOtherBeams) {
  OccupancyGrid grid({.resolution = 0.1});
  OwnedScan scan;
  scan.hits = {{2.1F, 0.05F}, {1.1F, 0.05F}, {1.11F, 0.06F}};  // the first beam passes the others
  grid.AddScan(SE2(0.05, 0.0, 0.0), scan.View());
  EXPECT_EQ(grid.LogOdds(11, 0), grid.options().hit_log_odds);
  EXPECT_EQ(grid.LogOdds(12, 0), grid.options().miss_log_odds);
  EXPECT_EQ(grid.LogOdds(21, 0), grid.options().hit_log_odds);
}

TEST(OccupancyGrid, BeamsWithoutReturnClearOnlyUpToTheirRange) {
  OccupancyGrid grid({.resolution = 0.1, .no_return_range = 1.0});
  OwnedScan scan;
  scan.no_returns = {{1.0F, 0.0F}};
  grid.AddScan(SE2(0.05, 0.05, 0.0), scan.View());
  EXPECT_EQ(grid.State(9, 0), CellState::kFree);
  EXPECT_EQ(grid.State(11, 0), CellState::kUnknown);
  const CellBox seen = grid.SeenBox();
  EXPECT_EQ(seen.width(), 10);
  EXPECT_EQ(seen.height(), 1);
}

TEST(OccupancyGrid, EvidenceSaturatesEitherWay) {
  OccupancyGrid grid({.resolution = 0.1, .max_log_odds = 2.0});
  OwnedScan scan;
  scan.hits = {{0.55F, 0.0F}};
  for (int i = 0; i < 50; ++i) grid.AddScan(SE2(0.05, 0.05, 0.0), scan.View());
  EXPECT_EQ(grid.LogOdds(6, 0), 2.0);
  EXPECT_EQ(grid.LogOdds(2, 0), -2.0);
}

TEST(OccupancyGrid, SeventyThousandScansCountAsMany) {
  OccupancyGrid grid({.resolution = 0.1, .hit_log_odds = 0.01, .max_log_odds = 300.0});
  OwnedScan scan;
  scan.hits = {{0.55F, 0.0F}};
  OwnedScan elsewhere;
  elsewhere.hits = {{-5.0F, 0.0F}};
  // More scans than there are scan numbers of a cell.
  for (int i = 0; i < 70000; ++i) {
    grid.AddScan(SE2(0.05, 0.05, 0.0), (i % 7 == 0 ? scan : elsewhere).View());
  }
  EXPECT_NEAR(grid.LogOdds(6, 0), 100.0, 1e-9);
}

TEST(OccupancyGrid, GrowingChangesNothing) {
  std::mt19937 random(12);
  std::vector<SE2> poses;
  std::vector<OwnedScan> scans;
  for (int i = 0; i < 60; ++i) {
    poses.push_back(SE2(0.4 * i, -0.7 * i, 0.1 * i) * RandomPose(&random));
    scans.push_back(RandomScan(&random));
  }
  OccupancyGrid grown;
  for (std::size_t i = 0; i < poses.size(); ++i) grown.AddScan(poses[i], scans[i].View());
  const OccupancyGrid rendered =
      RenderMap(poses, [&](std::size_t i) { return scans[i].View(); }, {});
  ExpectSameCells(grown, rendered);
}

TEST(OccupancyGrid, OrderOfScansDoesNotMatter) {
  std::mt19937 random(13);
  OccupancyGrid forwards;
  OccupancyGrid backwards;
  std::vector<SE2> poses;
  std::vector<OwnedScan> scans;
  for (int i = 0; i < 30; ++i) {
    poses.push_back(RandomPose(&random));
    scans.push_back(RandomScan(&random));
    forwards.AddScan(poses.back(), scans.back().View());
  }
  for (std::size_t i = scans.size(); i-- > 0;) backwards.AddScan(poses[i], scans[i].View());
  ExpectSameCells(forwards, backwards);
}

TEST(OccupancyGrid, CellsStayWhereTheyAreFarFromTheOrigin) {
  OccupancyGrid grid({.resolution = 0.1});
  OwnedScan scan;
  scan.hits = {{1.0F, 0.0F}};
  grid.AddScan(SE2(-5e6 + 0.05, 7e6 + 0.05, 0.0), scan.View());
  EXPECT_EQ(grid.State(-50'000'000 + 10, 70'000'000), CellState::kWall);
}

TEST(OccupancyGrid, AnEmptyGridHasSeenNothing) {
  const OccupancyGrid grid = RenderMap({}, [](std::size_t) { return MapScan{}; });
  EXPECT_TRUE(grid.SeenBox().empty());
  EXPECT_EQ(grid.State(0, 0), CellState::kUnknown);
}

TEST(OccupancyGrid, RefusesWhatHasNoPlaceAndStaysAsItWas) {
  OccupancyGrid grid;
  OwnedScan good;
  good.hits = {{1.0F, 0.0F}};
  grid.AddScan(SE2(), good.View());
  const CellBox before = grid.SeenBox();
  OwnedScan bad = good;
  bad.hits.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0F);
  for (const SE2& pose : {SE2(kNan, 0.0, 0.0), SE2(0.0, 0.0, kNan), SE2(1e300, 0.0, 0.0)}) {
    EXPECT_THAT([&] { grid.AddScan(pose, good.View()); },
                ThrowsMessage<Error>(HasSubstr("cannot be put on the map")));
  }
  EXPECT_THROW(grid.AddScan(SE2(), bad.View()), Error);
  EXPECT_EQ(grid.SeenBox().width(), before.width());
  EXPECT_EQ(grid.SeenBox().height(), before.height());
}

TEST(OccupancyGrid, RefusesAMapOfAHundredKilometres) {
  OccupancyGrid grid;
  OwnedScan scan;
  scan.hits = {{1.0F, 0.0F}};
  grid.AddScan(SE2(), scan.View());
  try {
    grid.AddScan(SE2(1e5, 1e5, 0.0), scan.View());
    FAIL() << "expected an Error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUsage);
    EXPECT_THAT(error.what(), HasSubstr("max_cells = 200000000"));
    EXPECT_THAT(error.what(), HasSubstr("coarser resolution"));
  }
}

TEST(RenderMap, NamesTheScanThatHasNoPlace) {
  OwnedScan scan;
  scan.hits = {{1.0F, 0.0F}};
  const std::vector<SE2> poses = {SE2(), SE2(), SE2(kNan, 0.0, 0.0)};
  EXPECT_THAT([&] { RenderMap(poses, [&](std::size_t) { return scan.View(); }); },
              ThrowsMessage<Error>(HasSubstr("scan 2: ")));
}

TEST(OccupancyGridOptions, NamesTheFieldThatIsOutOfRange) {
  const auto message = [](OccupancyGridOptions options) -> std::string {
    try {
      options.Validate();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({}), "");
  EXPECT_EQ(message({.resolution = 0.0}), "resolution is 0, expected 0.001 to 100000");
  EXPECT_THAT(message({.resolution = kNan}), HasSubstr("resolution is nan"));
  EXPECT_THAT(message({.hit_log_odds = -1.0}), HasSubstr("hit_log_odds is -1"));
  EXPECT_THAT(message({.miss_log_odds = 0.4}), HasSubstr("miss_log_odds is 0.4"));
  EXPECT_THAT(message({.max_log_odds = 1e6}), HasSubstr("max_log_odds"));
  EXPECT_THAT(message({.no_return_range = -1.0}), HasSubstr("no_return_range"));
  EXPECT_THAT(message({.max_cells = 0}), HasSubstr("max_cells"));
}

}  // namespace
}  // namespace loopgrid
