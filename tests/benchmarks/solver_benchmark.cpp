// Whole optimisations of public graphs beside Ceres, which solves the same least-squares problem
// with the same Jacobians from the same start; marginals; and how the cost grows with the graph.
// compare_solvers.sh makes tables of this.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "backend/guess/initial_guess.h"
#include "backend/solve/optimizer.h"
#include "tests/support/benchmark_graphs.h"
#include "tests/support/ceres_optimizer.h"
#include "tests/support/peak_memory.h"

namespace loopgrid {
namespace {

/// F is taken for the optimum if it is higher by at most this share.
constexpr double kTolerance = 1e-6;

template <typename Pose>
struct Task {
  PoseGraph<Pose> start;
  double optimum = 0.0;
};

template <typename Pose>
double Optimum(PoseGraph<Pose> start) {
  return Optimizer<Pose>().Optimize(&start).final_error;
}

/// Starts at the poses in the file, or at the chordal guess where this leads to a lower F.
template <typename Pose>
Task<Pose> MakeTask(const PoseGraph<Pose>& graph) {
  PoseGraph<Pose> guessed = graph;
  if (!SetChordalGuess(&guessed)) guessed = graph;
  const double from_file = Optimum(graph);
  const double from_guess = Optimum(guessed);
  if (from_guess < from_file * (1.0 - kTolerance)) return {std::move(guessed), from_guess};
  return {graph, from_file};
}

template <typename Pose>
using TaskSource = std::function<const Task<Pose>&()>;

/// Made at the first call.
template <typename Pose>
TaskSource<Pose> Lazy(const std::string& name) {
  auto task = std::make_shared<std::optional<Task<Pose>>>();
  return [task, name]() -> const Task<Pose>& {
    if (!*task) {
      const test_support::AnyGraph graph = test_support::BenchmarkGraph(name);
      *task = MakeTask(std::get<PoseGraph<Pose>>(graph));
    }
    return **task;
  };
}

double PeakMemoryMb(const std::string& what, const std::string& name) {
  return test_support::AskThisProgram(fmt::format("--peak-memory {} '{}'", what, name));
}

void Report(benchmark::State& state, double error, int iterations, double memory) {
  state.counters["F"] = error;
  state.counters["steps"] = iterations;
  state.counters["MB"] = memory;
}

template <typename Pose>
void CountGraph(benchmark::State& state, const PoseGraph<Pose>& graph) {
  state.counters["nodes"] = static_cast<double>(graph.poses.size());
  state.counters["edges"] = static_cast<double>(graph.constraints.size());
}

/// Times `optimize(graph)`, each time from the same start.
template <typename Pose, typename Optimize>
void Time(benchmark::State& state, const PoseGraph<Pose>& start, const Optimize& optimize) {
  for (auto _ : state) {
    state.PauseTiming();
    PoseGraph<Pose> graph = start;
    state.ResumeTiming();
    optimize(&graph);
  }
}

template <typename Pose>
void Loopgrid(benchmark::State& state, const std::string& name, const TaskSource<Pose>& task) {
  OptimizerResult result;
  Time(state, task().start,
       [&](PoseGraph<Pose>* graph) { result = Optimizer<Pose>().Optimize(graph); });
  Report(state, result.final_error, result.iterations, PeakMemoryMb("loopgrid", name));
  CountGraph(state, task().start);
}

template <typename Pose>
void Ceres(benchmark::State& state, const std::string& name, const TaskSource<Pose>& task,
           test_support::CeresSettings settings) {
  test_support::CeresResult result;
  const auto optimize = [&](PoseGraph<Pose>* graph) {
    result = OptimizeWithCeres(settings, graph);
  };
  const double enough = task().optimum * (1.0 + kTolerance);
  // Use the largest tolerance that reaches the optimum.
  for (double tolerance : {1e-5, 1e-6, 1e-7, 1e-8, 1e-10, 1e-12}) {
    settings.function_tolerance = tolerance;
    PoseGraph<Pose> graph = task().start;
    optimize(&graph);
    if (result.final_error <= enough) break;
  }
  if (result.final_error > enough) return state.SkipWithError("does not reach the optimum");
  Time(state, task().start, optimize);
  Report(state, result.final_error, result.iterations,
         PeakMemoryMb("ceres-" + settings.name, name));
}

/// Covariances of all nodes, given the factorisation.
template <typename Pose>
void AllMarginals(benchmark::State& state, const TaskSource<Pose>& task) {
  PoseGraph<Pose> graph = task().start;
  Optimizer<Pose> optimizer;
  optimizer.Optimize(&graph);
  if (!optimizer.ComputeMarginals(graph)) return state.SkipWithError("not positive definite");
  for (auto _ : state) benchmark::DoNotOptimize(optimizer.ComputeMarginals(graph));
}

OptimizerResult OptimizeFromGuess(PoseGraph<SE2>* graph) {
  if (!SetChordalGuess(graph)) return {};
  return Optimizer<SE2>().Optimize(graph);
}

/// A generated city, from odometry by the chordal guess to the optimum.
void Growth(benchmark::State& state, const std::string& name) {
  const auto world = std::get<PoseGraph<SE2>>(test_support::BenchmarkGraph(name));
  OptimizerResult result;
  Time(state, world, [&](PoseGraph<SE2>* graph) { result = OptimizeFromGuess(graph); });
  Report(state, result.final_error, result.iterations, PeakMemoryMb("growth", name));
  CountGraph(state, world);
}

template <typename Pose>
void Register(const std::string& name, const PoseGraph<Pose>&) {
  const TaskSource<Pose> task = Lazy<Pose>(name);
  const auto add = [&name](const std::string& what, auto run) {
    benchmark::RegisterBenchmark((what + "/" + name).c_str(), run)->Unit(benchmark::kMillisecond);
  };
  add("loopgrid", [=](benchmark::State& state) { Loopgrid<Pose>(state, name, task); });
  for (const test_support::CeresSettings& settings : test_support::AllCeresSettings()) {
    add("ceres-" + settings.name,
        [=](benchmark::State& state) { Ceres<Pose>(state, name, task, settings); });
  }
  add("marginals", [=](benchmark::State& state) { AllMarginals<Pose>(state, task); });
}

void RegisterAll() {
  for (const std::string& name : test_support::BenchmarkGraphNames()) {
    std::visit([&](const auto& graph) { Register(name, graph); },
               test_support::BenchmarkGraph(name));
  }
  for (const char* name : {"city1000", "city3000", "city10000", "city30000", "city100000"}) {
    benchmark::RegisterBenchmark((std::string("growth/") + name).c_str(),
                                 [name](benchmark::State& state) { Growth(state, name); })
        ->Unit(benchmark::kMillisecond);
  }
}

/// Takes the first steps of optimising a graph and prints the peak of the memory in MB. More steps
/// need no more memory.
template <typename Pose>
void PrintPeakMemory(const std::string& what, PoseGraph<Pose> graph) {
  const double before = test_support::ProcessStatusMb("VmRSS:");
  if constexpr (Pose::kDof == 3) {
    if (what == "growth") OptimizeFromGuess(&graph);
  }
  constexpr int kSteps = 3;
  OptimizerOptions options;
  options.max_iterations = kSteps;
  if (what == "loopgrid") Optimizer<Pose>(options).Optimize(&graph);
  for (test_support::CeresSettings settings : test_support::AllCeresSettings()) {
    settings.max_iterations = kSteps;
    if (what == "ceres-" + settings.name) OptimizeWithCeres(settings, &graph);
  }
  std::printf("%.3f\n", test_support::ProcessStatusMb("VmHWM:") - before);
}

}  // namespace
}  // namespace loopgrid

int main(int argc, char** argv) {
  if (argc == 4 && std::string(argv[1]) == "--peak-memory") {
    std::visit([&](const auto& graph) { loopgrid::PrintPeakMemory(argv[2], graph); },
               loopgrid::test_support::BenchmarkGraph(argv[3]));
    return 0;
  }
  loopgrid::RegisterAll();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
