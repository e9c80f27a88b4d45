#include "backend/solve/optimizer.h"

#include <algorithm>
#include <memory>
#include <span>

#include "backend/graph/constraint_error.h"
#include "backend/solve/descent.h"
#include "backend/solve/dog_leg.h"
#include "backend/solve/gauss_newton.h"
#include "backend/solve/graduated_loss.h"
#include "backend/solve/levenberg_marquardt.h"

namespace loopgrid {
namespace {

/// A stage of StageGoal::kFollow takes at most so many steps. It ends earlier if the next step
/// promises to lower F by less than this share.
constexpr int kFollowingSteps = 3;
constexpr double kFollowingDecrease = 1e-3;

template <typename Item>
bool BeginsWith(const std::vector<Item>& grown, const std::vector<Item>& start) {
  return grown.size() >= start.size() && std::equal(start.begin(), start.end(), grown.begin());
}

const OptimizerOptions& Validated(const OptimizerOptions& options) {
  options.Validate();
  return options;
}

template <typename Pose>
std::unique_ptr<StepMethod<Pose>> MakeMethod(Method method) {
  switch (method) {
    case Method::kGaussNewton:
      return std::make_unique<GaussNewton<Pose>>();
    case Method::kDogLeg:
      return std::make_unique<DogLeg<Pose>>();
    case Method::kLevenbergMarquardt:
      break;
  }
  return std::make_unique<LevenbergMarquardt<Pose>>();
}

}  // namespace

template <typename Pose>
Optimizer<Pose>::Optimizer(const OptimizerOptions& options)
    : options_(Validated(options)), linearization_(options.threads) {}

template <typename Pose>
OptimizerResult Optimizer<Pose>::Optimize(PoseGraph<Pose>* graph, const StepObserver& observer) {
  const Stopwatch watch;
  Validate(*graph);
  OptimizerResult result;
  if (double error = 0.0; IsAtOptimum(*graph, &error)) {
    result.initial_error = result.final_error = error;
    result.termination = Termination::kConverged;
    if (options_.trace) result.trace = {{error, TotalChi2(*graph), 0.0, 0.0, watch.seconds()}};
    return result;
  }
  linearization_.SetStructure(*graph);
  const auto minimize = [&](const RobustLoss& loss, StageGoal goal) {
    const Objective objective{loss, options_.parametrization};
    DescentOptions descent{options_.max_iterations,
                           options_.relative_decrease,
                           options_.absolute_decrease,
                           options_.trace,
                           observer,
                           watch};
    if (goal == StageGoal::kFollow) {
      descent.max_iterations = std::min(kFollowingSteps, options_.max_iterations);
      descent.relative_decrease = std::max(kFollowingDecrease, options_.relative_decrease);
    }
    const auto method = MakeMethod<Pose>(options_.method);
    return Descent<Pose>(objective, descent, &linearization_, graph).Run(method.get());
  };
  if (options_.graduated) {
    result = MinimizeGraduated<Pose>(options_.loss, minimize, graph);
    linearization_.InvalidateFactor();
  } else {
    result = minimize(options_.loss, StageGoal::kMinimize);
  }
  end_ = {*graph, result.final_error, result.termination == Termination::kConverged,
          linearization_.has_undamped_factor()};
  return result;
}

// The known part of the graph is at its minimum. So the sum can fall by no more than what the new
// edges add to F.
template <typename Pose>
bool Optimizer<Pose>::IsAtOptimum(const PoseGraph<Pose>& graph, double* error) const {
  const PoseGraph<Pose>& known = end_.graph;
  if (!end_.is_minimum || graph.fixed != known.fixed || !BeginsWith(graph.poses, known.poses) ||
      !BeginsWith(graph.landmarks, known.landmarks) ||
      !BeginsWith(graph.constraints, known.constraints) ||
      !BeginsWith(graph.observations, known.observations)) {
    return false;
  }
  const double added =
      TotalError<Pose>(graph, std::span(graph.constraints).subspan(known.constraints.size()),
                       std::span(graph.observations).subspan(known.observations.size()),
                       {options_.loss, options_.parametrization});
  *error = end_.error + added;
  return added <= std::max(options_.absolute_decrease, options_.relative_decrease * *error);
}

template <typename Pose>
std::optional<Marginals<Pose>> Optimizer<Pose>::ComputeMarginals(const PoseGraph<Pose>& graph) {
  if (!end_.is_factored || options_.parametrization != Parametrization::kManifold ||
      graph != end_.graph) {
    Validate(graph);
    end_.is_factored = false;
    linearization_.SetStructure(graph);
    linearization_.Linearize(graph, {options_.loss, Parametrization::kManifold});
  }
  if (linearization_.FactorizeForCovariances(graph, options_.careful_covariances) !=
      Definiteness::kDefinite)
    return std::nullopt;
  return linearization_.ComputeMarginals(graph);
}

template class Optimizer<SE2>;
template class Optimizer<SE3>;

}  // namespace loopgrid
