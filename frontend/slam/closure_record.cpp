#include "frontend/slam/closure_record.h"

namespace loopgrid {

const char* ToString(ClosureOutcome outcome) {
  switch (outcome) {
    case ClosureOutcome::kPending:
      return "pending";
    case ClosureOutcome::kAccepted:
      return "accepted";
    case ClosureOutcome::kLowScore:
      return "low-score";
    case ClosureOutcome::kAmbiguous:
      return "ambiguous";
    case ClosureOutcome::kContradicted:
      return "contradicted";
    case ClosureOutcome::kUnconstrained:
      return "unconstrained";
    case ClosureOutcome::kInconsistent:
      return "inconsistent";
    case ClosureOutcome::kRejected:
      return "rejected";
  }
  return "unknown";
}

}  // namespace loopgrid
