#include "backend/solve/optimizer_result.h"

namespace loopgrid {

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
    case Termination::kNotFinite:
      return "F is not finite at the start";
    case Termination::kCancelled:
      return "cancelled";
    case Termination::kNothingToMove:
      return "nothing to move";
  }
  return "unknown";
}

}  // namespace loopgrid
