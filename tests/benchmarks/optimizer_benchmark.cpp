// The parts of one iteration, covariances, and a graph that is optimised after each new node. Whole
// optimisations are in solver_benchmark.cpp.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <list>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "backend/solve/marginals.h"
#include "backend/solve/optimizer.h"
#include "backend/sparse/selected_inverse.h"
#include "tests/support/benchmark_graphs.h"
#include "tests/support/cholmod_solver.h"

namespace loopgrid {
namespace {

/// Linearised once.
template <typename Pose>
struct System {
  explicit System(const PoseGraph<Pose>& graph) {
    equations.SetStructure(graph);
    equations.Linearize(graph, {});
    factor.Analyze(equations.hessian());
    is_definite = factor.Factorize(equations.hessian());
  }
  NormalEquations<Pose> equations;
  SparseCholesky<Pose::kDof> factor;
  bool is_definite = false;
};

template <typename Pose>
void Linearize(benchmark::State& state, const PoseGraph<Pose>& graph, int threads) {
  System<Pose> system(graph);
  WorkerPool workers(threads);
  for (auto _ : state) {
    benchmark::DoNotOptimize(system.equations.Linearize(graph, {}, &workers));
  }
}

template <typename Pose>
void Analyze(benchmark::State& state, const PoseGraph<Pose>& graph) {
  const System<Pose> system(graph);
  for (auto _ : state) SparseCholesky<Pose::kDof>().Analyze(system.equations.hessian());
}

template <typename Solver, typename Pose>
void Factorize(benchmark::State& state, const PoseGraph<Pose>& graph) {
  const System<Pose> system(graph);
  Solver solver;
  solver.Analyze(system.equations.hessian());
  for (auto _ : state) {
    if (!solver.Factorize(system.equations.hessian())) state.SkipWithError("indefinite");
  }
}

template <typename Pose>
void Solve(benchmark::State& state, const PoseGraph<Pose>& graph) {
  const System<Pose> system(graph);
  if (!system.is_definite) state.SkipWithError("indefinite");
  for (auto _ : state) benchmark::DoNotOptimize(system.factor.Solve(system.equations.gradient()));
}

/// Covariances of all nodes relative to the first one, and relative to the last one.
template <typename Pose>
void Diagonal(benchmark::State& state, const PoseGraph<Pose>& graph) {
  const System<Pose> system(graph);
  if (!system.is_definite) state.SkipWithError("indefinite");
  for (auto _ : state) benchmark::DoNotOptimize(InverseDiagonal(system.factor));
}

template <typename Pose>
void RelativeToLast(benchmark::State& state, const PoseGraph<Pose>& graph) {
  const System<Pose> system(graph);
  if (!system.is_definite) state.SkipWithError("indefinite");
  const int last = static_cast<int>(graph.poses.size()) - 1;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        Marginals<Pose>(graph, system.equations, system.factor, {}).RelativeTo(last));
  }
}

/// The nodes one after the other, each with the constraints to those before it.
template <typename Pose>
void NodeByNode(benchmark::State& state, const PoseGraph<Pose>& whole) {
  std::vector<Constraint<Pose>> constraints = whole.constraints;
  std::stable_sort(constraints.begin(), constraints.end(), [](const auto& a, const auto& b) {
    return std::max(a.from, a.to) < std::max(b.from, b.to);
  });
  double error = 0.0;
  for (auto _ : state) {
    PoseGraph<Pose> graph;
    Optimizer<Pose> optimizer;
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

template <typename Pose>
void Register(const std::string& name, const PoseGraph<Pose>& graph) {
  const auto add = [&](const char* what, auto run) {
    benchmark::RegisterBenchmark((std::string(what) + "/" + name).c_str(),
                                 [run, &graph](benchmark::State& state) { run(state, graph); })
        ->Unit(benchmark::kMillisecond);
  };
  using State = benchmark::State;
  using Graph = PoseGraph<Pose>;
  add("Linearize", [](State& state, const Graph& g) { Linearize(state, g, 1); });
  add("LinearizeOnTwoThreads", [](State& state, const Graph& g) { Linearize(state, g, 2); });
  add("Analyze", Analyze<Pose>);
  add("Factorize", Factorize<SparseCholesky<Pose::kDof>, Pose>);
  add("FactorizeByCholmod", Factorize<test_support::CholmodSolver<Pose::kDof>, Pose>);
  add("Solve", Solve<Pose>);
  add("Diagonal", Diagonal<Pose>);
  add("RelativeToLast", RelativeToLast<Pose>);
  constexpr std::size_t kFew = 2000;
  if (graph.poses.size() < kFew) add("NodeByNode", NodeByNode<Pose>);
}

const bool kRegistered = [] {
  static std::list<test_support::AnyGraph> graphs;
  for (const std::string& name : test_support::BenchmarkGraphNames()) {
    graphs.push_back(test_support::BenchmarkGraph(name));
    std::visit([&](const auto& graph) { Register(name, graph); }, graphs.back());
  }
  return true;
}();

}  // namespace
}  // namespace loopgrid
