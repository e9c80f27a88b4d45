#include "backend/optimizer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

// Levenberg-Marquardt's lambda multiplies the Hessian's diagonal, so these have no unit.
constexpr double kFirstDamping = 1e-5;
constexpr double kLargestDamping = 1e10;
constexpr double kDampingFactor = 10.0;
constexpr double kSmallestScale = 1e-9;

// When F fell as the model promised, to within this share, the Hessian has hardly changed, and its
// factor serves for the next step too (a chord step of Newton's method), as long as each step
// promises less than this share of the one before.
constexpr double kGoodModel = 0.1;
constexpr double kSlow = 0.1;

void RequireAtLeastZero(const char* field, double value) {
  if (std::isfinite(value) && value >= 0.0) return;
  throw Error(ErrorCode::kUsage, fmt::format("{} is {}, expected at least 0", field, value));
}

/// Levenberg-Marquardt's lambda after a step that failed, and after one that did not.
double Stronger(double damping) { return std::max(kFirstDamping, damping * kDampingFactor); }

double Weaker(double damping) {
  const double weaker = damping / kDampingFactor;
  return weaker < kFirstDamping ? 0.0 : weaker;
}

}  // namespace

void OptimizerOptions::Validate() const {
  if (max_iterations < 0) {
    throw Error(ErrorCode::kUsage,
                fmt::format("max_iterations is {}, expected at least 0", max_iterations));
  }
  RequireAtLeastZero("relative_decrease", relative_decrease);
  RequireAtLeastZero("absolute_decrease", absolute_decrease);
  loss.Validate();
}

const char* ToString(Termination termination) {
  switch (termination) {
    case Termination::kConverged:
      return "converged";
    case Termination::kMaxIterations:
      return "iterations used up";
    case Termination::kStalled:
      return "no step lowers the error";
    case Termination::kIndefinite:
      return "Hessian not positive definite";
    case Termination::kNothingToMove:
      return "nothing to move";
  }
  return "unknown";
}

Optimizer::Optimizer(const OptimizerOptions& options) : options_(options) { options_.Validate(); }

OptimizerResult Optimizer::Optimize(PoseGraph* graph) {
  Validate(*graph);
  if (equations_.SetStructure(*graph)) factor_.Analyze(equations_.hessian());
  OptimizerResult result;
  result.initial_error = Linearize(*graph);
  result.final_error = result.initial_error;
  if (equations_.variable_count() > 0) Iterate(graph, &result);
  poses_ = graph->poses;
  return result;
}

void Optimizer::Iterate(PoseGraph* graph, OptimizerResult* result) {
  factor_fits_ = false;
  while (result->iterations < options_.max_iterations) {
    const std::optional<Termination> end = TakeStep(graph, result);
    if (end) {
      result->termination = *end;
      return;
    }
    ++result->iterations;
    Linearize(*graph);
  }
  result->termination = Termination::kMaxIterations;
}

double Optimizer::Linearize(const PoseGraph& graph) {
  factor_is_current_ = false;
  return equations_.Linearize(graph, options_.loss);
}

bool Optimizer::Factorize(double damping) {
  damping_ = damping > 0.0 ? damping * Scale() : Eigen::VectorXd();
  const bool is_definite = factor_.Factorize(equations_.hessian(), damping_);
  factor_is_current_ = is_definite && damping == 0.0;
  return is_definite;
}

// The Hessian's diagonal (Marquardt's scaling), kept off zero: no constraint may say anything about
// a direction.
Eigen::VectorXd Optimizer::Scale() const {
  const SymmetricBlockMatrix<3>& H = equations_.hessian();
  Eigen::VectorXd scale(3 * H.cols());
  for (int i = 0; i < H.cols(); ++i) scale.segment<3>(3 * i) = H.diagonal(i).diagonal();
  return scale.cwiseMax(kSmallestScale * scale.maxCoeff());
}

std::optional<Marginals> Optimizer::ComputeMarginals() {
  if (!factor_is_current_ && !Factorize(0.0)) return std::nullopt;
  return Marginals(poses_, equations_, factor_);
}

std::optional<Termination> Optimizer::TakeStep(PoseGraph* graph, OptimizerResult* result) {
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  if (factor_fits_) {
    const Step step = TryStep(graph, kSlow * last_promised_, result);
    if (step == Step::kTaken) return std::nullopt;
    if (step == Step::kNegligible) return Termination::kConverged;
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
    switch (TryStep(graph, kNoLimit, result)) {
      case Step::kTaken:
        damping = Weaker(damping);
        return std::nullopt;
      case Step::kNegligible:
        if (was_rejected) return Termination::kStalled;
        if (was_raised || damping == 0.0) return Termination::kConverged;
        damping = Weaker(damping);  // strong damping makes small steps: no sign of a minimum
        break;
      case Step::kRejected:
        damping = Stronger(damping);
        was_rejected = was_raised = true;
    }
  }
  return was_definite ? Termination::kStalled : Termination::kIndefinite;
}

Optimizer::Step Optimizer::TryStep(PoseGraph* graph, double most_promised,
                                   OptimizerResult* result) {
  factor_fits_ = false;
  const Eigen::VectorXd dx = factor_.Solve(-equations_.gradient());
  // The quadratic model falls by -(2 b^T dx + dx^T H dx), where (H + lambda D) dx = -b.
  double promised = -equations_.gradient().dot(dx);
  if (damping_.size() > 0) promised += dx.dot(damping_.cwiseProduct(dx));
  const double negligible =
      std::max(options_.absolute_decrease, options_.relative_decrease * result->final_error);
  if (promised <= negligible) return Step::kNegligible;
  if (promised > most_promised) return Step::kRejected;

  poses_ = graph->poses;
  for (std::size_t node = 0; node < graph->poses.size(); ++node) {
    const int variable = equations_.variable(static_cast<int>(node));
    if (variable >= 0) graph->poses[node] = poses_[node].Boxplus(dx.segment<3>(3 * variable));
  }
  const double error = NormalEquations::Error(*graph, options_.loss);
  const double decrease = result->final_error - error;
  if (!(decrease > 0.0)) {
    graph->poses.swap(poses_);
    return Step::kRejected;
  }
  result->final_error = error;
  last_promised_ = promised;
  factor_fits_ = result->damping == 0.0 && std::abs(decrease - promised) < kGoodModel * promised;
  return Step::kTaken;
}

}  // namespace loopgrid
