#pragma once

#include <limits>
#include <optional>

#include "backend/solve/descent.h"

namespace loopgrid {

/// Powell's dog leg (1970): each step goes along a DogLegPath up to the radius within which the
/// quadratic model is trusted. Lengths are measured in coordinates in which the Hessian's diagonal
/// is 1. Costs one factorisation a step.
template <typename Pose>
class DogLeg : public StepMethod<Pose> {
 public:
  std::optional<Termination> MakeStep(Descent<Pose>* descent) override;
  double damping() const override { return damping_; }

 private:
  double radius_ = std::numeric_limits<double>::infinity();  // of the trust region
  double damping_ = 0.0;  // more than 0 only where the Hessian is not positive semidefinite
};

extern template class DogLeg<SE2>;
extern template class DogLeg<SE3>;

}  // namespace loopgrid
