#include "backend/global/best_start.h"

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <utility>
#include <vector>

#include "backend/guess/initial_guess.h"
#include "backend/solve/normal_equations.h"

namespace loopgrid {
namespace {

/// Whether F is TotalChi2, of which there are certificates.
template <typename Pose>
bool IsSumOfSquares(const PoseGraph<Pose>& graph, const OptimizerOptions& options) {
  const auto is_robust = [](const auto& edge) { return edge.robust; };
  return options.parametrization == Parametrization::kManifold &&
         (options.loss.kind == LossKind::kQuadratic ||
          (std::ranges::none_of(graph.constraints, is_robust) &&
           std::ranges::none_of(graph.observations, is_robust)));
}

/// Moves the graph to a start; returns which one it is after all.
template <typename Pose>
InitialGuess SetGuess(InitialGuess guess, PoseGraph<Pose>* graph) {
  if (guess == InitialGuess::kChordal) {
    if (SetChordalGuess(graph)) return guess;
    guess = InitialGuess::kSpanningTree;
  }
  if (guess == InitialGuess::kSpanningTree) SetSpanningTreeGuess(graph);
  return guess;
}

/// Two starts are the same if they differ by less than this: a share of the mean length of the
/// constraints for positions, and radians (in 3D half of that) for rotations. What six digits in a
/// file take from the poses that a spanning tree gives is less.
constexpr double kSameStart = 1e-3;

template <typename Pose>
double MeanLength(const PoseGraph<Pose>& graph) {
  double sum = 0.0;
  for (const Constraint<Pose>& c : graph.constraints) sum += c.T_from_to.translation().norm();
  return sum / static_cast<double>(std::max<std::size_t>(1, graph.constraints.size()));
}

template <typename Pose>
class StartSearch {
 public:
  StartSearch(PoseGraph<Pose>* graph, Optimizer<Pose>* optimizer)
      : graph_(graph),
        optimizer_(optimizer),
        expected_error_(static_cast<double>(DegreesOfFreedom(*graph, ConnectedComponents(*graph)))),
        is_sum_of_squares_(IsSumOfSquares(*graph, optimizer->options())),
        same_distance_(kSameStart * MeanLength(*graph)),
        own_{graph->poses, graph->landmarks} {}

  BestStartResult Run() && {
    Try(SetFirstGuess());
    for (InitialGuess start :
         {InitialGuess::kChordal, InitialGuess::kSpanningTree, InitialGuess::kNone}) {
      if (is_settled_) break;
      Set(own_);
      const InitialGuess guess = SetGuess(start, graph_);
      if (!WasTried()) Try(guess);
    }
    Set(best_);
    return std::move(result_);
  }

 private:
  struct State {
    std::vector<Pose> poses;
    std::vector<typename Pose::Point> landmarks;
  };

  void Set(const State& state) {
    graph_->poses = state.poses;
    graph_->landmarks = state.landmarks;
  }

  bool IsSame(const State& start) const {
    constexpr int kDim = Pose::Point::RowsAtCompileTime;
    const auto is_same_pose = [this](const Pose& a, const Pose& b) {
      const typename Pose::Tangent difference = a.Boxminus(b);
      return difference.template head<kDim>().norm() <= same_distance_ &&
             difference.template tail<Pose::kDof - kDim>().norm() <= kSameStart;
    };
    const auto is_same_point = [this](const auto& a, const auto& b) {
      return (a - b).norm() <= same_distance_;
    };
    return std::ranges::equal(start.poses, graph_->poses, is_same_pose) &&
           std::ranges::equal(start.landmarks, graph_->landmarks, is_same_point);
  }

  /// Whether an optimisation has begun where the graph is.
  bool WasTried() const {
    return std::ranges::any_of(starts_, [this](const State& start) { return IsSame(start); });
  }

  InitialGuess SetFirstGuess() {
    const Objective objective{optimizer_->options().loss, optimizer_->options().parametrization};
    const double own_error = TotalError(*graph_, objective);
    if (own_error <= expected_error_) return InitialGuess::kNone;
    const InitialGuess guess = SetGuess(InitialGuess::kChordal, graph_);
    if (TotalError(*graph_, objective) < own_error) return guess;
    Set(own_);
    return InitialGuess::kNone;
  }

  void Try(InitialGuess start) {
    starts_.push_back({graph_->poses, graph_->landmarks});
    result_.trials.push_back({start, optimizer_->Optimize(graph_)});
    const double error = result_.trials.back().result.final_error;
    const std::size_t last = result_.trials.size() - 1;
    if (last > 0 && !(error < result_.trials[result_.best].result.final_error)) return;
    result_.best = last;
    best_ = {graph_->poses, graph_->landmarks};
    is_settled_ = error <= expected_error_;
    if (is_sum_of_squares_) {
      result_.certificate = CertifyOptimality(*graph_);
      is_settled_ = result_.certificate->kind == OptimalityCertificate::Kind::kGlobal;
    }
  }

  PoseGraph<Pose>* graph_;
  Optimizer<Pose>* optimizer_;
  double expected_error_;
  bool is_sum_of_squares_;
  double same_distance_;  // metres
  State own_;
  State best_;
  std::vector<State> starts_;  // of the trials
  bool is_settled_ = false;
  BestStartResult result_;
};

}  // namespace

const char* ToString(InitialGuess guess) {
  switch (guess) {
    case InitialGuess::kAuto:
      return "auto";
    case InitialGuess::kNone:
      return "none";
    case InitialGuess::kSpanningTree:
      return "spanning-tree";
    case InitialGuess::kChordal:
      return "chordal";
  }
  return "unknown";
}

template <typename Pose>
BestStartResult OptimizeFromBestStart(PoseGraph<Pose>* graph, Optimizer<Pose>* optimizer,
                                      InitialGuess start) {
  Validate(*graph);
  if (start == InitialGuess::kAuto) return StartSearch<Pose>(graph, optimizer).Run();
  BestStartResult result;
  const InitialGuess guess = SetGuess(start, graph);
  result.trials.push_back({guess, optimizer->Optimize(graph)});
  return result;
}

#define LOOPGRID_INSTANTIATE(Pose) \
  template BestStartResult OptimizeFromBestStart(PoseGraph<Pose>*, Optimizer<Pose>*, InitialGuess);
LOOPGRID_INSTANTIATE(SE2)
LOOPGRID_INSTANTIATE(SE3)
#undef LOOPGRID_INSTANTIATE

}  // namespace loopgrid
