#include "frontend/closing/closure.h"

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

const char* Explain(ClosureOutcome outcome) {
  switch (outcome) {
    case ClosureOutcome::kPending:
      return "waits for others that agree with it";
    case ClosureOutcome::kAccepted:
      return "others agree with it: it is in the graph";
    case ClosureOutcome::kLowScore:
      return "the scans do not fit well enough";
    case ClosureOutcome::kAmbiguous:
      return "a second place fits nearly as well";
    case ClosureOutcome::kContradicted:
      return "beams would have gone through walls";
    case ClosureOutcome::kUnconstrained:
      return "the fit leaves the place open, as in a bare corridor";
    case ClosureOutcome::kInconsistent:
      return "no others agree with it";
    case ClosureOutcome::kRejected:
      return "taken out again: it contradicts the rest of the graph";
  }
  return "";
}

}  // namespace loopgrid
