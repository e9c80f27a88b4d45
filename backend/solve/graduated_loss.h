#pragma once

#include <functional>

#include "backend/graph/pose_graph.h"
#include "backend/graph/robust_loss.h"
#include "backend/solve/optimizer_result.h"

namespace loopgrid {

/// How exactly a stage of a graduated descent is minimised.
enum class StageGoal {
  kFollow,    ///< a few steps: the next stage has another minimum anyway
  kMinimize,  ///< until the limits in the options end it
};

/// Minimises the graph's F with a loss, from where the graph is.
using MinimizeStage = std::function<OptimizerResult(const RobustLoss&, StageGoal)>;

/// Graduated non-convexity (Yang et al. 2020) for a Geman-McClure loss: follows the minimum from a
/// width at which nothing is an outlier down to the width of `loss`. Then minimises from the start
/// without the detour, too, and leaves the graph where F is lower.
/// `minimize` moves `graph`. The result counts the steps of all stages.
template <typename Pose>
OptimizerResult MinimizeGraduated(const RobustLoss& loss, const MinimizeStage& minimize,
                                  PoseGraph<Pose>* graph);

}  // namespace loopgrid
