#include "backend/solve/descent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "backend/graph/constraint_error.h"

namespace loopgrid {

template <typename Pose>
OptimizerResult Descent<Pose>::Run(StepMethod<Pose>* method) {
  const double start = linearization_.Linearize(graph_, objective_);
  result_.initial_error = result_.final_error =
      std::isfinite(start) ? start : std::numeric_limits<double>::infinity();
  Record(0.0);
  if (linearization_.variable_count() == 0) return std::move(result_);
  if (!std::isfinite(start)) {
    result_.termination = Termination::kNotFinite;
    return std::move(result_);
  }
  const auto is_cancelled = [&] {
    return options_.observer && !options_.observer({error(), TotalChi2(graph_), method->damping(),
                                                    last_step_, options_.watch.seconds()});
  };
  result_.termination = is_cancelled() ? Termination::kCancelled : Termination::kMaxIterations;
  while (may_continue() && result_.termination == Termination::kMaxIterations) {
    if (const std::optional<Termination> end = method->MakeStep(this)) {
      result_.termination = *end;
      break;
    }
    Record(method->damping());
    if (!std::isfinite(error())) break;
    if (is_cancelled()) result_.termination = Termination::kCancelled;
  }
  result_.damping = method->damping();
  if (best_ && !(error() <= best_->error)) {
    Restore(*best_);
    linearization_.InvalidateFactor();
    result_.final_error = best_->error;
    if (result_.termination != Termination::kCancelled) {
      result_.termination = Termination::kDiverged;
    }
  }
  return std::move(result_);
}

template <typename Pose>
double Descent<Pose>::negligible() const {
  return std::max(options_.absolute_decrease, options_.relative_decrease * error());
}

template <typename Pose>
void Descent<Pose>::Step(const Eigen::VectorXd& dx) {
  Checkpoint before = Save();
  linearization_.Move(dx, objective_.parametrization, &graph_);
  const double error = TotalError(graph_, objective_);
  if (!(error < before.error)) {
    ++result_.uphill_steps;
    if (!best_ || before.error < best_->error) best_ = std::move(before);
  }
  Count(error, dx);
}

template <typename Pose>
Trial Descent<Pose>::TryStep(const Eigen::VectorXd& dx, double promised) {
  if (promised <= negligible()) return {Trial::Kind::kNegligible};
  const Checkpoint before = Save();
  linearization_.Move(dx, objective_.parametrization, &graph_);
  const double error = TotalError(graph_, objective_);
  if (!(error < before.error)) {
    Restore(before);
    return {Trial::Kind::kRejected};
  }
  Count(error, dx);
  return {Trial::Kind::kTaken, (before.error - error) / promised};
}

template <typename Pose>
void Descent<Pose>::Count(double error, const Eigen::VectorXd& dx) {
  result_.final_error = error;
  last_step_ = dx.norm();
  ++result_.iterations;
  linearization_.Linearize(graph_, objective_);
}

template <typename Pose>
void Descent<Pose>::Record(double damping) {
  if (!options_.trace) return;
  result_.trace.push_back(
      {error(), TotalChi2(graph_), damping, last_step_, options_.watch.seconds()});
}

template <typename Pose>
typename Descent<Pose>::Checkpoint Descent<Pose>::Save() const {
  return {graph_.poses,       graph_.landmarks,     error(),
          result_.iterations, result_.uphill_steps, result_.trace.size()};
}

template <typename Pose>
void Descent<Pose>::ReturnTo(const Checkpoint& checkpoint) {
  Restore(checkpoint);
  result_.final_error = checkpoint.error;
  result_.iterations = checkpoint.iterations;
  result_.uphill_steps = checkpoint.uphill_steps;
  result_.trace.resize(checkpoint.records);
  linearization_.Linearize(graph_, objective_);
}

template <typename Pose>
void Descent<Pose>::Restore(const Checkpoint& checkpoint) {
  graph_.poses = checkpoint.poses;
  graph_.landmarks = checkpoint.landmarks;
}

template class Descent<SE2>;
template class Descent<SE3>;

}  // namespace loopgrid
