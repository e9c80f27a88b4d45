// Graph files in memory: bytes per second of processor time, unpacked.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <random>
#include <string>
#include <string_view>

#include "backend/base/gzip.h"
#include "backend/base/parse_number.h"
#include "backend/files/graph_file.h"
#include "tests/support/manhattan_world.h"
#include "tests/support/memory_file.h"

namespace loopgrid {
namespace {

constexpr int kNodes = 20000;

PoseGraph<SE2> Graph2() { return test_support::ManhattanWorld(kNodes, 4, 1); }

/// A walk through space, each node joined to the last three.
PoseGraph<SE3> Graph3() {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 0.1);
  const auto any = [&] {
    return SE3::Tangent(SE3::Tangent::NullaryExpr([&] { return normal(random); }));
  };
  PoseGraph<SE3> graph;
  graph.poses.emplace_back();
  for (int node = 1; node < kNodes; ++node) {
    graph.poses.push_back(graph.poses.back() * SE3::Exp(10.0 * any()));
    for (int other = std::max(0, node - 3); other < node; ++other) {
      const Eigen::Matrix<double, 6, 6> root =
          Eigen::Matrix<double, 6, 6>::NullaryExpr([&] { return normal(random); });
      graph.constraints.push_back(
          {other, node,
           (graph.poses[static_cast<std::size_t>(other)].Inverse() * graph.poses.back())
               .Boxplus(0.1 * any()),
           100.0 * (root * root.transpose() + Eigen::Matrix<double, 6, 6>::Identity())});
    }
  }
  return graph;
}

/// The text with numbers as most programs write them: six digits.
std::string WithSixDigits(std::string_view text) {
  std::string rounded;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    FieldCursor fields(text.substr(0, end));
    text.remove_prefix(end + 1);
    rounded += fields.Next();
    while (!fields.AtEnd()) {
      const std::string_view field = fields.Next();
      double number = 0.0;
      const bool is_integer = field.find_first_of(".e") == std::string_view::npos;
      if (is_integer || !ParseNumber(field, &number)) {
        fmt::format_to(std::back_inserter(rounded), " {}", field);
      } else {
        fmt::format_to(std::back_inserter(rounded), " {:g}", number);
      }
    }
    rounded += '\n';
  }
  return rounded;
}

void CountBytes(benchmark::State& state, std::size_t size) {
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(size));
}

void Read(benchmark::State& state, const std::string& text, const std::string& stored) {
  const test_support::MemoryFile file(stored);
  const std::string path = file.path();
  for (auto _ : state) benchmark::DoNotOptimize(ReadGraph(path));
  CountBytes(state, text.size());
}

template <typename Pose>
void Write(benchmark::State& state, const PoseGraph<Pose>& graph, GraphFormat format) {
  std::size_t size = 0;
  for (auto _ : state) {
    const std::string text = FormatGraph(graph, {}, format);
    size = text.size();
    benchmark::DoNotOptimize(text.data());
  }
  CountBytes(state, size);
}

template <typename Pose>
void RegisterFormat(const std::string& name, const PoseGraph<Pose>& graph, GraphFormat format) {
  const std::string text = FormatGraph(graph, {}, format);
  const std::string short_text = WithSixDigits(text);
  const auto add = [](const std::string& title, auto run) {
    benchmark::RegisterBenchmark(title.c_str(), run)->Unit(benchmark::kMillisecond);
  };
  add("Read/" + name, [=](benchmark::State& state) { Read(state, text, text); });
  add("Read/" + name + "/six_digits",
      [=](benchmark::State& state) { Read(state, short_text, short_text); });
  add("Read/" + name + "/gzip", [=](benchmark::State& state) { Read(state, text, Gzip(text)); });
  add("Write/" + name, [=](benchmark::State& state) { Write(state, graph, format); });
}

const bool kRegistered = [] {
  RegisterFormat("g2o2D", Graph2(), GraphFormat::kG2o);
  RegisterFormat("g2o3D", Graph3(), GraphFormat::kG2o);
  RegisterFormat("toro2D", Graph2(), GraphFormat::kToro);
  RegisterFormat("toro3D", Graph3(), GraphFormat::kToro);
  return true;
}();

}  // namespace
}  // namespace loopgrid
