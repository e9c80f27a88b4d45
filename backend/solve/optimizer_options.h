#pragma once

#include "backend/graph/parametrization.h"
#include "backend/graph/robust_loss.h"

namespace loopgrid {

/// How a step is made of the linearised problem H dx = -b.
enum class Method {
  /// Gauss-Newton steps as long as they lower F, at once or within the next few steps; damped ones
  /// (Marquardt 1963) where they do not.
  kLevenbergMarquardt,
  /// Full steps, whether they lower F or not: Algorithms 1 and 2 of the tutorial to the letter.
  kGaussNewton,
  /// Powell's dog leg: the Gauss-Newton step, or on the way to it from that of steepest descent as
  /// far as the model has proved right. One factorisation a step.
  kDogLeg,
};

struct OptimizerOptions {
  Method method = Method::kLevenbergMarquardt;
  Parametrization parametrization = Parametrization::kManifold;
  int max_iterations = 100;  ///< steps, with a graduated loss of each of its stages
  /// Stop when the next step promises to lower F by less than this share of F ...
  double relative_decrease = 1e-8;
  /// ... or by less than this (F counts squared standard deviations).
  double absolute_decrease = 1e-9;
  /// Of the constraints and observations marked robust.
  RobustLoss loss;
  /// Graduated non-convexity (Yang et al. 2020), for Geman-McClure losses: begins with a width at
  /// which nothing is an outlier and narrows it, so that the start matters less. Where that
  /// ends higher than the start it is done without.
  bool graduated = false;
  int threads = 1;     ///< to linearise large graphs; the result does not depend on it
  bool trace = false;  ///< fill in OptimizerResult::trace
  /// Compute covariances with twice the digits unless a bound says that double precision gives them
  /// to a hundredth. It matters where information matrices differ by many orders of magnitude. The
  /// bound is far too large on long chains, where this costs several times the time for nothing.
  bool careful_covariances = true;

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

}  // namespace loopgrid
