#pragma once

#include <limits>
#include <optional>

#include "backend/solve/descent.h"

namespace loopgrid {

/// Powell's dog leg (1970): along a DogLegPath as far as the model has proved right, in the
/// coordinates in which the Hessian's diagonal is 1. One factorisation a step.
template <typename Pose>
class DogLeg : public StepMethod<Pose> {
 public:
  std::optional<Termination> MakeStep(Descent<Pose>* descent) override;
  double damping() const override { return damping_; }

 private:
  double radius_ = std::numeric_limits<double>::infinity();  // of the trust region
  double damping_ = 0.0;  // only as much as makes the Hessian positive semidefinite
};

extern template class DogLeg<SE2>;
extern template class DogLeg<SE3>;

}  // namespace loopgrid
