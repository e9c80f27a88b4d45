#pragma once

#include <functional>
#include <vector>

namespace loopgrid {

enum class Termination {
  kConverged,      ///< a Gauss-Newton step without damping would lower F by a negligible amount
  kMaxIterations,  ///< still improving when the iterations were used up
  kStalled,        ///< no step, however short, lowers F: rounding errors hide any decrease
  kDiverged,       ///< Gauss-Newton ended at a higher F than that of an earlier point
  kIndefinite,     ///< the Hessian is not positive definite, or stays so however strongly damped
  kNotFinite,      ///< F overflows at the start: nothing was moved
  kCancelled,      ///< the observer asked to stop
  kNothingToMove,  ///< no node, or all of them held
};

/// One English phrase: "converged", ...
const char* ToString(Termination termination);

/// The state after a step.
struct IterationRecord {
  double error = 0.0;    ///< F
  double chi2 = 0.0;     ///< TotalChi2: F without robust losses and not in Euler angles
  double damping = 0.0;  ///< Levenberg-Marquardt's lambda
  double step = 0.0;     ///< length of the increment, all variables together
  double seconds = 0.0;  ///< since the call
};

/// Is called at the start and after every step. The optimiser stops if it returns false.
using StepObserver = std::function<bool(const IterationRecord&)>;

struct OptimizerResult {
  double initial_error = 0.0;  ///< F at the start (with the robust loss)
  double final_error = 0.0;    ///< F at the end; never more than at the start
  int iterations = 0;          ///< steps taken
  int uphill_steps = 0;        ///< of these, the steps that did not lower F
  double damping = 0.0;        ///< Levenberg-Marquardt's lambda at the end; 0: Gauss-Newton
  Termination termination = Termination::kNothingToMove;
  std::vector<IterationRecord> trace;  ///< the start and every step
};

}  // namespace loopgrid
