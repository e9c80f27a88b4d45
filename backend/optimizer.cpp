#include "backend/optimizer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

// Levenberg-Marquardt's lambda multiplies the Hessian's diagonal (Marquardt's scaling), so these
// have no unit.
constexpr double kFirstDamping = 1e-5;
constexpr double kLargestDamping = 1e10;
constexpr double kDampingFactor = 10.0;

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
  while (result->iterations < options_.max_iterations) {
    const Step step = TakeStep(graph, result);
    if (step == Step::kNegligible || step == Step::kNotFound || step == Step::kIndefinite) {
      result->termination = step == Step::kNegligible ? Termination::kConverged
                            : step == Step::kNotFound ? Termination::kStalled
                                                      : Termination::kIndefinite;
      return;
    }
    ++result->iterations;
    Linearize(*graph);
    // The model held all the way, so the Hessian has hardly changed: its last factor can tell
    // whether another step is worth while.
    if (step == Step::kTakenAsPromised &&
        PromisedDecrease(factor_.Solve(-equations_.gradient()), 0.0) <= Negligible(*result)) {
      result->termination = Termination::kConverged;
      return;
    }
  }
  result->termination = Termination::kMaxIterations;
}

double Optimizer::Negligible(const OptimizerResult& result) const {
  return std::max(options_.absolute_decrease, options_.relative_decrease * result.final_error);
}

double Optimizer::Linearize(const PoseGraph& graph) {
  factor_is_current_ = false;
  return equations_.Linearize(graph, options_.loss);
}

bool Optimizer::Factorize(double damping) {
  const bool is_definite = factor_.Factorize(equations_.hessian(), damping);
  factor_is_current_ = is_definite && damping == 0.0;
  return is_definite;
}

std::optional<Marginals> Optimizer::ComputeMarginals() {
  if (!factor_is_current_ && !Factorize(0.0)) return std::nullopt;
  return Marginals(poses_, equations_, factor_);
}

Optimizer::Step Optimizer::TakeStep(PoseGraph* graph, OptimizerResult* result) {
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
    const Eigen::VectorXd dx = factor_.Solve(-equations_.gradient());
    const double promised = PromisedDecrease(dx, damping);
    if (promised <= Negligible(*result)) {
      if (was_rejected) return Step::kNotFound;
      if (was_raised || damping == 0.0) return Step::kNegligible;
      // Strong damping alone makes steps small: that is no sign of a minimum.
      damping = Weaker(damping);
      continue;
    }
    const double before = result->final_error;
    if (TryStep(graph, dx, &result->final_error)) {
      const bool as_promised = std::abs(before - result->final_error - promised) < 0.1 * promised;
      const Step step = as_promised && damping == 0.0 ? Step::kTakenAsPromised : Step::kTaken;
      damping = Weaker(damping);
      return step;
    }
    damping = Stronger(damping);
    was_rejected = was_raised = true;
  }
  return was_definite ? Step::kNotFound : Step::kIndefinite;
}

// With (H + lambda D) dx = -b the quadratic model falls by -(2 b^T dx + dx^T H dx).
double Optimizer::PromisedDecrease(const Eigen::VectorXd& dx, double damping) const {
  double promised = -equations_.gradient().dot(dx);
  if (damping == 0.0) return promised;
  const SymmetricBlockMatrix<3>& H = equations_.hessian();
  for (int i = 0; i < H.cols(); ++i) {
    promised += damping * dx.segment<3>(3 * i).cwiseAbs2().dot(H.diagonal(i).diagonal());
  }
  return promised;
}

bool Optimizer::TryStep(PoseGraph* graph, const Eigen::VectorXd& dx, double* error) {
  poses_ = graph->poses;
  for (std::size_t node = 0; node < graph->poses.size(); ++node) {
    const int variable = equations_.variable(static_cast<int>(node));
    if (variable >= 0) graph->poses[node] = poses_[node].Boxplus(dx.segment<3>(3 * variable));
  }
  const double new_error = NormalEquations::Error(*graph, options_.loss);
  if (new_error < *error) {
    *error = new_error;
    return true;
  }
  graph->poses.swap(poses_);
  return false;
}

}  // namespace loopgrid
