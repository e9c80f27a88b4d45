// Optimising pose graphs: from the start in the file to the optimum, the parts of one iteration,
// and a graph that is optimised after each node while it grows.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "backend/optimizer.h"
#include "tests/support/benchmark_graphs.h"
#include "tests/support/cholmod_solver.h"

namespace loopgrid {
namespace {

using test_support::NamedGraph;

void ToOptimum(benchmark::State& state, const PoseGraph<SE2>& start) {
  OptimizerResult result;
  for (auto _ : state) {
    state.PauseTiming();
    PoseGraph<SE2> graph = start;
    state.ResumeTiming();
    result = Optimizer<SE2>().Optimize(&graph);
  }
  state.counters["iterations"] = result.iterations;
  state.counters["F"] = result.final_error;
  state.counters["per_iteration"] =
      benchmark::Counter(result.iterations, benchmark::Counter::kIsIterationInvariantRate |
                                                benchmark::Counter::kInvert);
}

/// Linearised once, for the benchmarks of the parts.
struct System {
  explicit System(const PoseGraph<SE2>& graph) {
    equations.SetStructure(graph);
    equations.Linearize(graph, {});
  }
  NormalEquations<SE2> equations;
};

void Linearize(benchmark::State& state, const PoseGraph<SE2>& graph) {
  System system(graph);
  for (auto _ : state) {
    benchmark::DoNotOptimize(system.equations.Linearize(graph, {}));
  }
}

void Analyze(benchmark::State& state, const PoseGraph<SE2>& graph) {
  const System system(graph);
  for (auto _ : state) SparseCholesky<3>().Analyze(system.equations.hessian());
}

template <typename Solver>
void Factorize(benchmark::State& state, const PoseGraph<SE2>& graph) {
  const System system(graph);
  Solver solver;
  solver.Analyze(system.equations.hessian());
  for (auto _ : state) {
    if (!solver.Factorize(system.equations.hessian())) state.SkipWithError("indefinite");
  }
}

void Solve(benchmark::State& state, const PoseGraph<SE2>& graph) {
  const System system(graph);
  SparseCholesky<3> factor;
  factor.Analyze(system.equations.hessian());
  if (!factor.Factorize(system.equations.hessian())) state.SkipWithError("indefinite");
  for (auto _ : state) benchmark::DoNotOptimize(factor.Solve(system.equations.gradient()));
}

/// The nodes one after the other, each with the constraints to those before it.
void NodeByNode(benchmark::State& state, const PoseGraph<SE2>& whole) {
  std::vector<Constraint<SE2>> constraints = whole.constraints;
  std::stable_sort(constraints.begin(), constraints.end(), [](const auto& a, const auto& b) {
    return std::max(a.from, a.to) < std::max(b.from, b.to);
  });
  double error = 0.0;
  for (auto _ : state) {
    PoseGraph<SE2> graph;
    Optimizer<SE2> optimizer;
    auto next = constraints.begin();
    for (int node = 0; node < static_cast<int>(whole.poses.size()); ++node) {
      graph.poses.push_back(whole.poses[static_cast<std::size_t>(node)]);
      for (; next != constraints.end() && std::max(next->from, next->to) == node; ++next) {
        graph.constraints.push_back(*next);
        if (next->to == node && next->from == node - 1) {
          graph.poses.back() = graph.poses[static_cast<std::size_t>(node - 1)] * next->T_from_to;
        }
      }
      error = optimizer.Optimize(&graph).final_error;
    }
  }
  state.counters["F"] = error;
}

const bool kRegistered = [] {
  using benchmark::kMillisecond;
  using benchmark::RegisterBenchmark;
  static const std::vector<NamedGraph> graphs = test_support::BenchmarkGraphs();
  for (const NamedGraph& named : graphs) {
    const PoseGraph<SE2>& graph = named.graph;
    const auto add = [&](const char* what, void (*run)(benchmark::State&, const PoseGraph<SE2>&)) {
      const std::string name = std::string(what) + "/" + named.name;
      return RegisterBenchmark(name.c_str(),
                               [run, &graph](benchmark::State& state) { run(state, graph); })
          ->Unit(kMillisecond);
    };
    add("ToOptimum", ToOptimum);
    add("Linearize", Linearize);
    add("Analyze", Analyze);
    add("Factorize", Factorize<SparseCholesky<3>>);
    add("FactorizeByCholmod", Factorize<test_support::CholmodSolver>);
    add("Solve", Solve);
    if (graph.poses.size() < 2000) add("NodeByNode", NodeByNode);
  }
  return true;
}();

}  // namespace
}  // namespace loopgrid
