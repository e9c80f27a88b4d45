// Covariances of all nodes, after the factorisation: relative to the first node (selected
// inversion), and relative to the last one (a solve more).

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "backend/marginals.h"
#include "backend/selected_inverse.h"
#include "tests/support/benchmark_graphs.h"

namespace loopgrid {
namespace {

using test_support::NamedGraph;

struct Factored {
  explicit Factored(const PoseGraph<SE2>& graph) {
    equations.SetStructure(graph);
    equations.Linearize(graph, {});
    factor.Analyze(equations.hessian());
    is_definite = factor.Factorize(equations.hessian());
  }
  NormalEquations<SE2> equations;
  SparseCholesky<3> factor;
  bool is_definite = false;
};

void Diagonal(benchmark::State& state, const PoseGraph<SE2>& graph) {
  const Factored factored(graph);
  if (!factored.is_definite) state.SkipWithError("indefinite");
  for (auto _ : state) benchmark::DoNotOptimize(InverseDiagonal(factored.factor));
}

void RelativeToLast(benchmark::State& state, const PoseGraph<SE2>& graph) {
  const Factored factored(graph);
  if (!factored.is_definite) state.SkipWithError("indefinite");
  const int last = static_cast<int>(graph.poses.size()) - 1;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        Marginals<SE2>(graph.poses, factored.equations, factored.factor).RelativeTo(last));
  }
}

const bool kRegistered = [] {
  static const std::vector<NamedGraph> graphs = test_support::BenchmarkGraphs();
  for (const NamedGraph& named : graphs) {
    const PoseGraph<SE2>& graph = named.graph;
    const auto add = [&](const char* what, void (*run)(benchmark::State&, const PoseGraph<SE2>&)) {
      const std::string name = std::string(what) + "/" + named.name;
      benchmark::RegisterBenchmark(name.c_str(), [run, &graph](benchmark::State& state) {
        run(state, graph);
      })->Unit(benchmark::kMillisecond);
    };
    add("Diagonal", Diagonal);
    add("RelativeToLast", RelativeToLast);
  }
  return true;
}();

}  // namespace
}  // namespace loopgrid
