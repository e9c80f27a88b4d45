#include "backend/solve/optimizer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "backend/solve/dog_leg.h"

namespace loopgrid {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Levenberg-Marquardt's lambda multiplies the Hessian's diagonal, so these have no unit.
constexpr double kFirstDamping = 1e-5;
constexpr double kLargestDamping = 1e10;
constexpr double kDampingFactor = 10.0;
constexpr double kOvershot = 0.25;  // share of the promised decrease
constexpr double kSmallestScale = 1e-9;

// When F fell as the model promised, to within this share, the Hessian has hardly changed, and its
// factor serves for the next step too (a chord step of Newton's method), as long as each step
// promises less than this share of the one before.
constexpr double kGoodModel = 0.1;
constexpr double kSlow = 0.1;

constexpr double kSmallestRadius = 1e-12;

// Full steps on trial after one that does not lower F, and trials that may fail in a row. A trial
// has to lower F by this share of what its first step promised, or else to and fro is progress.
constexpr int kLookAhead = 3;
constexpr int kTrials = 3;
constexpr double kWorthwhile = 0.1;

// The square of a graduated loss's width falls by this factor at a time (Yang et al. 2020).
constexpr double kGraduation = 1.4;

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

/// Levenberg-Marquardt's lambda after a step that failed, and after one that did not.
double Stronger(double damping) { return std::max(kFirstDamping, damping * kDampingFactor); }

double Weaker(double damping) {
  const double weaker = damping / kDampingFactor;
  return weaker < kFirstDamping ? 0.0 : weaker;
}

/// The largest e^T Omega e of the constraints and observations that may be wrong.
template <typename Pose>
double LargestRobustChi2(const PoseGraph<Pose>& graph) {
  double largest = 0.0;
  const auto look_at = [&](const auto& edges) {
    for (const auto& edge : edges) {
      if (edge.robust) largest = std::max(largest, Chi2(graph, edge));
    }
  };
  look_at(graph.constraints);
  look_at(graph.observations);
  return largest;
}

template <typename Item>
bool BeginsWith(const std::vector<Item>& grown, const std::vector<Item>& start) {
  return grown.size() >= start.size() && std::equal(start.begin(), start.end(), grown.begin());
}

}  // namespace

const char* ToString(Termination termination) {
  switch (termination) {
    case Termination::kConverged:
      return "converged";
    case Termination::kMaxIterations:
      return "iterations used up";
    case Termination::kStalled:
      return "no step lowers the error";
    case Termination::kDiverged:
      return "diverged";
    case Termination::kIndefinite:
      return "Hessian not positive definite";
    case Termination::kNothingToMove:
      return "nothing to move";
  }
  return "unknown";
}

template <typename Pose>
Optimizer<Pose>::Optimizer(const OptimizerOptions& options)
    : options_(options),
      objective_{options.loss, options.parametrization},
      workers_(std::max(1, options.threads)) {
  options_.Validate();
}

template <typename Pose>
OptimizerResult Optimizer<Pose>::Optimize(PoseGraph<Pose>* graph) {
  start_ = std::chrono::steady_clock::now();
  loopgrid::Validate(*graph);
  OptimizerResult result;
  if (double error = 0.0; IsAtOptimum(*graph, &error)) {
    result.initial_error = result.final_error = error;
    result.termination = Termination::kConverged;
    Record(*graph, &result);
    return result;
  }
  result = options_.graduated ? MinimizeGraduated(graph) : Minimize(graph);
  end_ = {result.termination == Termination::kConverged, result.final_error, *graph};
  return result;
}

// What has been added can lower F by no more than what it adds to it: the rest is at its minimum.
template <typename Pose>
bool Optimizer<Pose>::IsAtOptimum(const PoseGraph<Pose>& graph, double* error) const {
  const PoseGraph<Pose>& known = end_.graph;
  if (!end_.is_minimum || graph.fixed != known.fixed || !BeginsWith(graph.poses, known.poses) ||
      !BeginsWith(graph.landmarks, known.landmarks) ||
      !BeginsWith(graph.constraints, known.constraints) ||
      !BeginsWith(graph.observations, known.observations)) {
    return false;
  }
  const double added = TotalError<Pose>(
      graph, std::span(graph.constraints).subspan(known.constraints.size()),
      std::span(graph.observations).subspan(known.observations.size()), objective_);
  *error = end_.error + added;
  return added <= std::max(options_.absolute_decrease, options_.relative_decrease * *error);
}

template <typename Pose>
OptimizerResult Optimizer<Pose>::Minimize(PoseGraph<Pose>* graph) {
  OptimizerResult result;
  SetStructure(*graph);
  result.initial_error = Linearize(*graph);
  result.final_error = result.initial_error;
  Record(*graph, &result);
  if (equations_.variable_count() > 0) Iterate(graph, &result);
  return result;
}

template <typename Pose>
OptimizerResult Optimizer<Pose>::MinimizeGraduated(PoseGraph<Pose>* graph) {
  const State start = StateOf(*graph);
  const double initial_error = TotalError(*graph, objective_);
  OptimizerResult result;
  const auto minimize = [&](const RobustLoss& loss) {
    objective_.loss = loss;
    OptimizerResult stage = Minimize(graph);
    result.iterations += stage.iterations;
    result.uphill_steps += stage.uphill_steps;
    result.damping = stage.damping;
    result.termination = stage.termination;
    result.trace.insert(result.trace.end(), stage.trace.begin(), stage.trace.end());
    return stage.final_error;
  };
  minimize({LossKind::kQuadratic, options_.loss.width});
  double width = std::sqrt(2.0 * LargestRobustChi2(*graph));
  for (; width > options_.loss.width; width /= std::sqrt(kGraduation)) {
    minimize({LossKind::kGemanMcClure, width});
  }
  result.final_error = minimize(options_.loss);
  if (!(result.final_error <= initial_error)) {  // led astray: without the detour, then
    Restore(start, graph);
    result.final_error = minimize(options_.loss);
  }
  result.initial_error = initial_error;
  return result;
}

template <typename Pose>
void Optimizer<Pose>::SetStructure(const PoseGraph<Pose>& graph) {
  if (equations_.SetStructure(graph)) factor_.Analyze(equations_.hessian());
}

template <typename Pose>
void Optimizer<Pose>::Iterate(PoseGraph<Pose>* graph, OptimizerResult* result) {
  factor_fits_ = false;
  failed_trials_ = 0;
  radius_ = kInfinity;
  State best = StateOf(*graph);
  double best_error = result->final_error;
  result->termination = Termination::kMaxIterations;
  while (result->iterations < options_.max_iterations) {
    if (const std::optional<Termination> end = TakeStep(graph, result)) {
      result->termination = *end;
      break;
    }
    ++result->iterations;
    Linearize(*graph);
    Record(*graph, result);
    if (options_.method != Method::kGaussNewton) continue;
    if (result->final_error < best_error) {
      best = StateOf(*graph);
      best_error = result->final_error;
    } else if (!std::isfinite(result->final_error)) {
      break;
    }
  }
  if (options_.method == Method::kGaussNewton && !(result->final_error <= best_error)) {
    Restore(best, graph);
    factor_is_current_ = false;
    result->final_error = best_error;
    result->termination = Termination::kDiverged;
  }
}

template <typename Pose>
double Optimizer<Pose>::Linearize(const PoseGraph<Pose>& graph) {
  factor_is_current_ = false;
  return equations_.Linearize(graph, objective_, &workers_);
}

template <typename Pose>
bool Optimizer<Pose>::Factorize(double damping) {
  damping_ = damping > 0.0 ? damping * Scale() : Eigen::VectorXd();
  const bool is_definite = factor_.Factorize(equations_.hessian(), damping_);
  factor_is_current_ = is_definite && damping == 0.0;
  return is_definite;
}

// The Hessian's diagonal (Marquardt's scaling), kept off zero: no constraint may say anything about
// a direction.
template <typename Pose>
Eigen::VectorXd Optimizer<Pose>::Scale() const {
  const auto& H = equations_.hessian();
  Eigen::VectorXd scale(kDof * H.cols());
  for (int i = 0; i < H.cols(); ++i) {
    scale.segment<kDof>(kDof * i) = H.diagonal(i).diagonal();
  }
  return scale.cwiseMax(kSmallestScale * scale.maxCoeff());
}

template <typename Pose>
std::optional<Marginals<Pose>> Optimizer<Pose>::ComputeMarginals(const PoseGraph<Pose>& graph) {
  if (!factor_is_current_ || options_.parametrization != Parametrization::kManifold ||
      graph != end_.graph) {
    loopgrid::Validate(graph);
    SetStructure(graph);
    equations_.Linearize(graph, {options_.loss, Parametrization::kManifold}, &workers_);
    const bool is_definite = Factorize(0.0);
    factor_is_current_ = false;
    if (!is_definite) return std::nullopt;
  }
  return Marginals<Pose>(graph, equations_, factor_);
}

template <typename Pose>
double Optimizer<Pose>::Negligible(const OptimizerResult& result) const {
  return std::max(options_.absolute_decrease, options_.relative_decrease * result.final_error);
}

template <typename Pose>
std::optional<Termination> Optimizer<Pose>::TakeStep(PoseGraph<Pose>* graph,
                                                     OptimizerResult* result) {
  switch (options_.method) {
    case Method::kGaussNewton:
      return GaussNewtonStep(graph, result);
    case Method::kDogLeg:
      return DogLegStep(graph, result);
    case Method::kLevenbergMarquardt:
      break;
  }
  return LevenbergMarquardtStep(graph, result);
}

template <typename Pose>
std::optional<Termination> Optimizer<Pose>::GaussNewtonStep(PoseGraph<Pose>* graph,
                                                            OptimizerResult* result) {
  if (!Factorize(0.0)) return Termination::kIndefinite;
  const Eigen::VectorXd dx = factor_.Solve(-equations_.gradient());
  if (-equations_.gradient().dot(dx) <= Negligible(*result)) return Termination::kConverged;
  Move(graph, dx);
  const double error = TotalError(*graph, objective_);
  if (!(error < result->final_error)) ++result->uphill_steps;
  result->final_error = error;
  last_step_ = dx.norm();
  return std::nullopt;
}

template <typename Pose>
std::optional<Termination> Optimizer<Pose>::LevenbergMarquardtStep(PoseGraph<Pose>* graph,
                                                                   OptimizerResult* result) {
  if (factor_fits_) {
    const Trial trial = TryFactor(graph, kSlow * last_promised_, result);
    if (trial == Trial::kTaken) return std::nullopt;
    if (trial == Trial::kNegligible) return Termination::kConverged;
  }
  double& damping = result->damping;
  bool was_definite = false;
  bool was_rejected = false;
  bool was_raised = false;
  while (damping <= kLargestDamping) {
    if (!Factorize(damping)) {
      damping = Stronger(damping);
      was_raised = true;
      continue;
    }
    was_definite = true;
    switch (TryFactor(graph, kInfinity, result)) {
      case Trial::kTaken:
        // A step that overshoots comes out little lower on the other side: shorter ones from there.
        damping = last_gain_ < kOvershot ? Stronger(damping) : Weaker(damping);
        return std::nullopt;
      case Trial::kNegligible:
        if (was_rejected) return Termination::kStalled;
        if (was_raised || damping == 0.0) return Termination::kConverged;
        damping = Weaker(damping);  // strong damping makes small steps: no sign of a minimum
        break;
      case Trial::kRejected:
        if (damping == 0.0 && LookAhead(graph, result)) return std::nullopt;
        damping = Stronger(damping);
        was_rejected = was_raised = true;
    }
  }
  return was_definite ? Termination::kStalled : Termination::kIndefinite;
}

// In a valley that bends, a Gauss-Newton step leads up its side and the next ones down to its floor
// again, further along than short steps get: worth a trial (the watchdog of Chamberlain et al.
// 1982).
template <typename Pose>
bool Optimizer<Pose>::LookAhead(PoseGraph<Pose>* graph, OptimizerResult* result) {
  if (failed_trials_ >= kTrials) return false;
  const State start = StateOf(*graph);
  OptimizerResult ahead = *result;
  double enough = 0.0;
  for (int step = 0; step < kLookAhead && ahead.iterations < options_.max_iterations; ++step) {
    const Eigen::VectorXd dx = factor_.Solve(-equations_.gradient());
    if (step == 0) enough = result->final_error + kWorthwhile * equations_.gradient().dot(dx);
    last_step_ = dx.norm();
    Move(graph, dx);
    ahead.final_error = TotalError(*graph, objective_);
    if (ahead.final_error < enough) {
      *result = std::move(ahead);
      failed_trials_ = 0;
      return true;
    }
    if (!std::isfinite(ahead.final_error)) break;
    ++ahead.iterations;
    ++ahead.uphill_steps;
    Record(*graph, &ahead);
    Linearize(*graph);
    if (!Factorize(0.0)) break;
  }
  ++failed_trials_;
  Restore(start, graph);
  Linearize(*graph);
  return false;
}

template <typename Pose>
typename Optimizer<Pose>::Trial Optimizer<Pose>::TryFactor(PoseGraph<Pose>* graph,
                                                           double most_promised,
                                                           OptimizerResult* result) {
  factor_fits_ = false;
  const Eigen::VectorXd dx = factor_.Solve(-equations_.gradient());
  // The quadratic model falls by -(2 b^T dx + dx^T H dx), where (H + lambda D) dx = -b.
  double promised = -equations_.gradient().dot(dx);
  if (damping_.size() > 0) promised += dx.dot(damping_.cwiseProduct(dx));
  if (promised > most_promised) return Trial::kRejected;
  const Trial trial = TryStep(graph, dx, promised, result);
  factor_fits_ =
      trial == Trial::kTaken && result->damping == 0.0 && std::abs(last_gain_ - 1.0) < kGoodModel;
  return trial;
}

// In the coordinates in which the Hessian's diagonal is 1.
template <typename Pose>
std::optional<Termination> Optimizer<Pose>::DogLegStep(PoseGraph<Pose>* graph,
                                                       OptimizerResult* result) {
  double& damping = result->damping;  // only as much as makes the Hessian definite
  while (!Factorize(damping)) {
    damping = Stronger(damping);
    if (damping > kLargestDamping) return Termination::kIndefinite;
  }
  const auto& H = equations_.hessian();
  const Eigen::VectorXd& b = equations_.gradient();
  const Eigen::VectorXd newton = factor_.Solve(-b);
  if (-b.dot(newton) <= Negligible(*result)) return Termination::kConverged;
  const Eigen::VectorXd scale = Scale();
  Eigen::VectorXd cauchy = -b.cwiseQuotient(scale);
  cauchy *= -b.dot(cauchy) / cauchy.dot(H * cauchy);  // the minimum along the steepest descent
  const DogLeg path(cauchy, newton, scale);

  while (radius_ > kSmallestRadius) {
    const Eigen::VectorXd dx = path.PointWithin(radius_);
    const double promised = -2.0 * b.dot(dx) - dx.dot(H * dx);
    const Trial trial = TryStep(graph, dx, promised, result);
    if (trial == Trial::kNegligible) return Termination::kStalled;
    const double gain = trial == Trial::kTaken ? last_gain_ : -kInfinity;
    radius_ = NextRadius(radius_, path.Length(dx), gain);
    if (trial == Trial::kRejected) continue;
    damping = Weaker(damping);
    return std::nullopt;
  }
  return Termination::kStalled;
}

template <typename Pose>
typename Optimizer<Pose>::Trial Optimizer<Pose>::TryStep(PoseGraph<Pose>* graph,
                                                         const Eigen::VectorXd& dx, double promised,
                                                         OptimizerResult* result) {
  if (promised <= Negligible(*result)) return Trial::kNegligible;
  before_.poses = graph->poses;
  before_.landmarks = graph->landmarks;
  Move(graph, dx);
  const double error = TotalError(*graph, objective_);
  if (!(error < result->final_error)) {
    Restore(before_, graph);
    return Trial::kRejected;
  }
  last_gain_ = (result->final_error - error) / promised;
  last_promised_ = promised;
  last_step_ = dx.norm();
  result->final_error = error;
  return Trial::kTaken;
}

template <typename Pose>
void Optimizer<Pose>::Move(PoseGraph<Pose>* graph, const Eigen::VectorXd& dx) const {
  for (int node = 0; node < static_cast<int>(graph->poses.size()); ++node) {
    const int variable = equations_.variable(node);
    if (variable < 0) continue;
    Pose& pose = graph->poses[Index(node)];
    pose = Increment<Pose>(pose, dx.segment<kDof>(kDof * variable), objective_.parametrization);
  }
  for (int landmark = 0; landmark < static_cast<int>(graph->landmarks.size()); ++landmark) {
    const int variable = equations_.landmark_variable(landmark);
    if (variable < 0) continue;
    constexpr int kPoint = Pose::Point::RowsAtCompileTime;
    graph->landmarks[Index(landmark)] += dx.segment<kPoint>(kDof * variable);
  }
}

template <typename Pose>
void Optimizer<Pose>::Restore(const State& state, PoseGraph<Pose>* graph) {
  graph->poses = state.poses;
  graph->landmarks = state.landmarks;
}

template <typename Pose>
void Optimizer<Pose>::Record(const PoseGraph<Pose>& graph, OptimizerResult* result) {
  if (!options_.trace) return;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  result->trace.push_back({result->final_error, TotalChi2(graph), result->damping,
                           result->trace.empty() ? 0.0 : last_step_, elapsed.count()});
}

template class Optimizer<SE2>;
template class Optimizer<SE3>;

}  // namespace loopgrid
