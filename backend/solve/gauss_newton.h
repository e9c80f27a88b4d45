#pragma once

#include <optional>

#include "backend/solve/descent.h"

namespace loopgrid {

/// Takes full steps whether they lower F or not, exactly as Algorithms 1 and 2 of the tutorial do.
template <typename Pose>
class GaussNewton : public StepMethod<Pose> {
 public:
  std::optional<Termination> MakeStep(Descent<Pose>* descent) override;
};

extern template class GaussNewton<SE2>;
extern template class GaussNewton<SE3>;

}  // namespace loopgrid
