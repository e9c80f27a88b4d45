#include "backend/solve/graduated_loss.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "backend/graph/constraint_error.h"

namespace loopgrid {
namespace {

// The square of the width falls by this factor at a time (Yang et al. 2020).
constexpr double kGraduation = 1.4;

/// The largest e^T Omega e of the constraints and observations that may be wrong.
template <typename Pose>
double LargestRobustChi2(const PoseGraph<Pose>& graph) {
  double largest = 0.0;
  const auto look_at = [&](const auto& edges) {
    for (const auto& edge : edges) {
      if (edge.robust) largest = std::max(largest, Chi2(graph, edge));
    }
  };
  look_at(graph.constraints);
  look_at(graph.observations);
  return largest;
}

/// The results of all stages as one.
class Stages {
 public:
  explicit Stages(const MinimizeStage& minimize) : minimize_(minimize) {}

  OptimizerResult Run(const RobustLoss& loss, StageGoal goal) {
    OptimizerResult stage = minimize_(loss, goal);
    sum_.iterations += stage.iterations;
    sum_.uphill_steps += stage.uphill_steps;
    sum_.trace.insert(sum_.trace.end(), stage.trace.begin(), stage.trace.end());
    is_over_ = stage.termination == Termination::kCancelled ||
               stage.termination == Termination::kNothingToMove;
    return stage;
  }

  /// Whether there is no point in more of them.
  bool is_over() const { return is_over_; }

  /// With the end of one of the stages, and the error before all of them.
  OptimizerResult Finish(const OptimizerResult& end, double initial_error) {
    sum_.initial_error = initial_error;
    sum_.final_error = end.final_error;
    sum_.damping = end.damping;
    sum_.termination = end.termination;
    return sum_;
  }

 private:
  const MinimizeStage& minimize_;
  OptimizerResult sum_;
  bool is_over_ = false;
};

}  // namespace

template <typename Pose>
OptimizerResult MinimizeGraduated(const RobustLoss& loss, const MinimizeStage& minimize,
                                  PoseGraph<Pose>* graph) {
  const std::vector<Pose> poses = graph->poses;
  const auto landmarks = graph->landmarks;
  Stages stages(minimize);
  stages.Run({LossKind::kQuadratic, loss.width}, StageGoal::kFollow);
  double width = std::sqrt(2.0 * LargestRobustChi2(*graph));
  if (!std::isfinite(width)) width = 0.0;  // F overflows: no width is wide enough to begin with
  for (; width > loss.width && !stages.is_over(); width /= std::sqrt(kGraduation)) {
    stages.Run({LossKind::kGemanMcClure, width}, StageGoal::kFollow);
  }
  const OptimizerResult graduated = stages.Run(loss, StageGoal::kMinimize);
  const std::vector<Pose> graduated_poses = graph->poses;
  const auto graduated_landmarks = graph->landmarks;

  graph->poses = poses;
  graph->landmarks = landmarks;
  const OptimizerResult direct = stages.Run(loss, StageGoal::kMinimize);
  if (direct.final_error < graduated.final_error) {
    return stages.Finish(direct, direct.initial_error);
  }
  graph->poses = graduated_poses;
  graph->landmarks = graduated_landmarks;
  return stages.Finish(graduated, direct.initial_error);
}

template OptimizerResult MinimizeGraduated(const RobustLoss&, const MinimizeStage&,
                                           PoseGraph<SE2>*);
template OptimizerResult MinimizeGraduated(const RobustLoss&, const MinimizeStage&,
                                           PoseGraph<SE3>*);

}  // namespace loopgrid
