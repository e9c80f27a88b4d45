#pragma once

#include <functional>

#include "backend/graph/pose_graph.h"
#include "backend/graph/robust_loss.h"
#include "backend/solve/optimizer_result.h"

namespace loopgrid {

/// How exactly a stage of a graduated descent is minimised.
enum class StageGoal {
  kFollow,    ///< a few steps, since the next stage has another minimum
  kMinimize,  ///< until the limits in the options end it
};

/// Minimises the graph's F with a loss, from where the graph is.
using MinimizeStage = std::function<OptimizerResult(const RobustLoss&, StageGoal)>;

/// Graduated non-convexity (Yang et al. 2020) for a Geman-McClure loss. Follows the minimum of F
/// from a width at which nothing is an outlier down to the width of `loss`. Also minimises from the
/// start without that. Leaves each of the two ends again with losses up to 32 times wider, in case
/// that leads to a lower one, and leaves the graph at the lowest end of all.
/// `minimize` moves `graph`. The result counts the steps of all stages.
template <typename Pose>
OptimizerResult MinimizeGraduated(const RobustLoss& loss, const MinimizeStage& minimize,
                                  PoseGraph<Pose>* graph);

}  // namespace loopgrid
