// Speed of reading CARMEN logs, in bytes of text a second. The goal is 100 MB/s on one core.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <iterator>
#include <string>

#include "backend/base/gzip.h"
#include "backend/base/line_reader.h"
#include "frontend/log/open_log.h"
#include "tests/support/memory_file.h"

namespace loopgrid {
namespace {

// A log like that of a SICK laser: 180 readings in centimetres, some without return.
std::string SickLog(int scans) {
  std::string log = "PARAM robot_frontlaser_offset 0.0 nohost 0\n";
  std::uint32_t state = 1;
  for (int i = 0; i < scans; ++i) {
    log += "FLASER 180";
    for (int k = 0; k < 180; ++k) {
      state = state * 1664525U + 1013904223U;
      const int centimetres = state >> 28U == 0 ? 8183 : static_cast<int>((state >> 16U) % 1500);
      fmt::format_to(std::back_inserter(log), " {}.{:02}", centimetres / 100, centimetres % 100);
    }
    const double x = 0.05 * i;
    fmt::format_to(std::back_inserter(log),
                   " {0:.6f} {1:.6f} {2:.6f} {0:.6f} {1:.6f} {2:.6f} {3:.6f} nohost {4:.6f}\n", x,
                   std::sin(x), std::cos(x), 976052857.767368 + 0.2 * i, 0.2 * i);
  }
  return log;
}

void ReadLog(benchmark::State& state, const std::string& text, const std::string& file_content) {
  const test_support::MemoryFile file(file_content);
  for (auto _ : state) {
    const auto reader = OpenLog(file.path());
    Observation observation;
    while (reader->Next(&observation)) benchmark::DoNotOptimize(observation.scan.ranges.data());
    if (reader->statistics().malformed > 0) state.SkipWithError("malformed lines");
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) *
                          static_cast<std::int64_t>(text.size()));
}

void BM_ReadPlainLog(benchmark::State& state) {
  const std::string log = SickLog(2'000);
  ReadLog(state, log, log);
}
BENCHMARK(BM_ReadPlainLog)->Unit(benchmark::kMillisecond);

void BM_ReadGzippedLog(benchmark::State& state) {
  const std::string log = SickLog(2'000);
  ReadLog(state, log, Gzip(log));
}
BENCHMARK(BM_ReadGzippedLog)->Unit(benchmark::kMillisecond);

// The part of this that splits the text into lines.
void BM_ReadPlainLines(benchmark::State& state) {
  const std::string log = SickLog(2'000);
  const test_support::MemoryFile file(log);
  for (auto _ : state) {
    LineReader lines(file.path());
    std::string_view line;
    while (lines.Next(&line)) benchmark::DoNotOptimize(line.data());
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) *
                          static_cast<std::int64_t>(log.size()));
}
BENCHMARK(BM_ReadPlainLines)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace loopgrid
