// Drawing a map: scans of the size and number of the Intel Research Lab log (8,946 x 180 beams,
// mean range 2.9 m), all of them at 5 cm.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "mapping/occupancy_grid.h"

namespace loopgrid {
namespace {

constexpr int kScans = 8946;
constexpr int kBeams = 180;

struct Recording {
  std::vector<SE2> poses;
  std::vector<std::vector<Eigen::Vector2f>> hits;
};

// The robot drives rounds in a square building; each beam ends between 0.4 m and 5.4 m.
Recording MakeRecording() {
  Recording recording;
  std::size_t draw = 1;
  const auto uniform = [&draw] {
    draw = draw * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(draw >> 40) / static_cast<double>(1 << 24);
  };
  for (int i = 0; i < kScans; ++i) {
    const double along = 20.0 * std::numbers::pi * i / kScans;
    recording.poses.emplace_back(10.0 * std::cos(along), 10.0 * std::sin(along), along);
    std::vector<Eigen::Vector2f> hits;
    for (int k = 0; k < kBeams; ++k) {
      const double angle = std::numbers::pi * (k / 180.0 - 0.5);
      const double range = 0.4 + 2.5 * (1.0 + std::sin(5.0 * angle + along)) + 0.04 * uniform();
      hits.emplace_back(static_cast<float>(range * std::cos(angle)),
                        static_cast<float>(range * std::sin(angle)));
    }
    recording.hits.push_back(std::move(hits));
  }
  return recording;
}

void RenderWholeLog(benchmark::State& state) {
  const Recording recording = MakeRecording();
  const auto scan_at = [&recording](std::size_t i) {
    return MapScan{.origin = Eigen::Vector2d::Zero(), .hits = recording.hits[i], .no_returns = {}};
  };
  for (auto _ : state) benchmark::DoNotOptimize(RenderMap(recording.poses, scan_at));
  state.SetItemsProcessed(state.iterations() * kScans * kBeams);
}
BENCHMARK(RenderWholeLog)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace loopgrid
