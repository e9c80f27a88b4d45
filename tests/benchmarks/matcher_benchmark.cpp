// Scan matching: each of its steps for one scan of a simulated office (180 beams) against the map
// of twenty nodes before it, as tracking does it.

#include <benchmark/benchmark.h>

#include <cstddef>
#include <vector>

#include "frontend/matching/correlative_matcher.h"
#include "frontend/matching/match_covariance.h"
#include "frontend/matching/match_refiner.h"
#include "frontend/matching/thinning.h"
#include "tests/support/office_world.h"

namespace loopgrid {
namespace {

constexpr float kResolution = 0.05F;
constexpr float kSigma = 0.07F;

// The scans of a stretch along a corridor and into a room.
struct Drive {
  std::vector<PointScan> scans;
  std::vector<SE2> poses;

  Drive() {
    const std::vector<Eigen::Vector2d> route = {{7.0, 7.0}, {9.0, 7.0}, {9.0, 3.5}};
    const test_support::SimulatedRun run =
        test_support::Simulate(test_support::OfficeWorld(), route);
    for (const Observation& observation : run.observations) {
      scans.push_back(MakePointScan(observation.scan, 0.05, 30.0));
    }
    poses = run.true_poses;
  }

  // All but the last scan.
  LocalMap Map() const {
    std::vector<PlacedScan> placed;
    for (std::size_t i = scans.size() - 21; i + 1 < scans.size(); ++i) {
      placed.push_back({&scans[i], poses[i]});
    }
    return LocalMap(placed, poses.back().translation(), 30.0);
  }
};

LikelihoodTable TableOf(const LocalMap& map, const SearchWindow& window, int levels) {
  std::vector<Eigen::Vector2f> surfaces;
  for (const Surfel& surfel : map.surfels()) surfaces.push_back(surfel.position);
  const int margin = CorrelativeSearch::MarginFor(window, kResolution, levels) + 5;
  return {surfaces, map.lower(), map.upper(), margin, kResolution, kSigma, levels};
}

void MakeLocalMap(benchmark::State& state) {
  const Drive drive;
  for (auto _ : state) benchmark::DoNotOptimize(drive.Map());
}
BENCHMARK(MakeLocalMap)->Unit(benchmark::kMicrosecond);

void MakeTable(benchmark::State& state) {
  const LocalMap map = Drive().Map();
  for (auto _ : state) benchmark::DoNotOptimize(TableOf(map, {1.0, 1.0, 0.6}, 4));
}
BENCHMARK(MakeTable)->Unit(benchmark::kMicrosecond);

// Half widths in centimetres and hundredths of a radian.
void Search(benchmark::State& state) {
  const Drive drive;
  const double reach = 0.01 * static_cast<double>(state.range(0));
  const SearchWindow window{reach, reach, 0.01 * static_cast<double>(state.range(1))};
  const LocalMap map = drive.Map();
  const LikelihoodTable table = TableOf(map, window, 6);
  const std::vector<Eigen::Vector2f> points = ThinPoints(drive.scans.back().hits, kResolution);
  const SE2 center = drive.poses.back().Boxplus({0.4 * reach, -0.3 * reach, 0.02});
  const double step = AngleStepFor(points, static_cast<double>(kResolution));
  for (auto _ : state) {
    const CorrelativeSearch search(table, points, center, window, step);
    benchmark::DoNotOptimize(search.Best(0.5));
  }
}
BENCHMARK(Search)
    ->Args({15, 10})
    ->Args({30, 20})
    ->Args({100, 60})
    ->Args({500, 300})
    ->Unit(benchmark::kMicrosecond);

void Refine(benchmark::State& state) {
  const Drive drive;
  const LocalMap map = drive.Map();
  const SE2 start = drive.poses.back().Boxplus({0.03, -0.02, 0.01});
  const PosePrior prior{start, Eigen::Matrix3d::Zero()};
  for (auto _ : state) {
    benchmark::DoNotOptimize(RefineMatch(map, drive.scans.back(), start, prior));
  }
}
BENCHMARK(Refine)->Unit(benchmark::kMicrosecond);

void Covariance(benchmark::State& state) {
  const Drive drive;
  const LocalMap map = drive.Map();
  const LikelihoodTable table = TableOf(map, {1.0, 1.0, 0.6}, 4);
  const SE2& pose = drive.poses.back();
  const RefinedMatch match =
      RefineMatch(map, drive.scans.back(), pose, {pose, Eigen::Matrix3d::Zero()});
  const std::vector<Eigen::Vector2f> points = ThinPoints(drive.scans.back().hits, kResolution);
  for (auto _ : state) benchmark::DoNotOptimize(MatchCovariance(table, points, match));
}
BENCHMARK(Covariance)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace loopgrid
