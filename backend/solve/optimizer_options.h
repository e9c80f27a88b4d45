#pragma once

#include "backend/graph/parametrization.h"
#include "backend/graph/robust_loss.h"

namespace loopgrid {

/// How a step is made of the linearised problem H dx = -b.
enum class Method {
  /// Takes Gauss-Newton steps as long as they lower F, at once or within the next few steps. Where
  /// they do not, it takes damped steps (Marquardt 1963).
  kLevenbergMarquardt,
  /// Takes full steps whether they lower F or not, exactly as Algorithms 1 and 2 of the tutorial
  /// do.
  kGaussNewton,
  /// Powell's dog leg: takes the Gauss-Newton step, or, where that is too long for the quadratic
  /// model to be trusted, a point between it and the step of steepest descent. One factorisation a
  /// step.
  kDogLeg,
};

struct OptimizerOptions {
  Method method = Method::kLevenbergMarquardt;
  Parametrization parametrization = Parametrization::kManifold;
  int max_iterations = 100;  ///< steps; with a graduated loss, steps of each of its stages
  /// Stop when the next step promises to lower F by less than this share of F ...
  double relative_decrease = 1e-8;
  /// ... or by less than this (F counts squared standard deviations).
  double absolute_decrease = 1e-9;
  /// The loss of the constraints and observations that are marked robust.
  RobustLoss loss;
  /// Graduated non-convexity (Yang et al. 2020), for Geman-McClure losses: begins with a width at
  /// which nothing is an outlier and narrows it, so that the result depends less on the start. Ends
  /// no higher than the same loss does without it. See MinimizeGraduated.
  bool graduated = false;
  int threads = 1;     ///< used to linearise large graphs; the result does not depend on it
  bool trace = false;  ///< fill in OptimizerResult::trace
  /// Compute covariances with twice the digits, unless a bound on rounding errors says that double
  /// precision gives them to a hundredth. This matters where information matrices differ by many
  /// orders of magnitude. On long chains the bound is thousands of times too large, so that this
  /// can take several times longer without need.
  bool careful_covariances = true;

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

}  // namespace loopgrid
