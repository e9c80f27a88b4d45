#include "backend/solve/graduated_loss.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "backend/graph/constraint_error.h"

namespace loopgrid {
namespace {

// The square of the width falls by this factor from stage to stage (Yang et al. 2020).
constexpr double kGraduation = 1.4;

// A minimum is left again with a loss that is wider by the first factor, its square, its cube and
// so on up to the second; the square of the width then falls by the third from stage to stage.
constexpr double kWidening = 2.0;
constexpr double kWidest = 32.0;
constexpr double kFastGraduation = 2.0;

// Ends whose errors differ by a smaller share are the same.
constexpr double kSameError = 1e-6;

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

template <typename Pose>
class GraduatedDescent {
 public:
  GraduatedDescent(const RobustLoss& loss, const MinimizeStage& minimize, PoseGraph<Pose>* graph)
      : loss_(loss), minimize_(minimize), graph_(*graph) {}

  OptimizerResult Run() && {
    const End start = EndHere({});
    RunStage({LossKind::kQuadratic, loss_.width}, StageGoal::kFollow);
    End best = Narrow(std::sqrt(2.0 * LargestRobustChi2(graph_)), kGraduation);
    Improve(&best);
    GoTo(start);
    End direct = EndHere(RunStage(loss_, StageGoal::kMinimize));
    const double initial_error = direct.result.initial_error;
    if (!IsSame(direct, best)) Improve(&direct);
    if (direct.result.final_error < best.result.final_error) best = std::move(direct);
    GoTo(best);
    sum_.initial_error = initial_error;
    sum_.final_error = best.result.final_error;
    sum_.damping = best.result.damping;
    sum_.termination = was_cancelled_ ? Termination::kCancelled : best.result.termination;
    return std::move(sum_);
  }

 private:
  /// Where a descent has ended.
  struct End {
    OptimizerResult result;
    std::vector<Pose> poses;
    std::vector<typename Pose::Point> landmarks;
  };

  OptimizerResult RunStage(const RobustLoss& loss, StageGoal goal) {
    OptimizerResult stage = minimize_(loss, goal);
    sum_.iterations += stage.iterations;
    sum_.uphill_steps += stage.uphill_steps;
    sum_.trace.insert(sum_.trace.end(), stage.trace.begin(), stage.trace.end());
    was_cancelled_ |= stage.termination == Termination::kCancelled;
    has_ended_ = was_cancelled_ || stage.termination == Termination::kNothingToMove ||
                 stage.termination == Termination::kNotFinite;
    return stage;
  }

  /// Follows the minimum from a width down to that of the loss.
  End Narrow(double width, double factor) {
    if (!std::isfinite(width)) width = 0.0;  // F overflows: no width is wide enough to begin with
    for (; width > loss_.width && !has_ended_; width /= std::sqrt(factor)) {
      RunStage({LossKind::kGemanMcClure, width}, StageGoal::kFollow);
    }
    return EndHere(RunStage(loss_, StageGoal::kMinimize));
  }

  /// Leaves the end with wider losses, which see outliers that have been left out again, and goes
  /// back to the loss; the end becomes the lowest one found.
  void Improve(End* end) {
    for (double factor = kWidening; factor <= kWidest && !has_ended_; factor *= kWidening) {
      GoTo(*end);
      End other = Narrow(factor * loss_.width, kFastGraduation);
      if (other.result.final_error < end->result.final_error) *end = std::move(other);
    }
  }

  static bool IsSame(const End& a, const End& b) {
    return std::abs(a.result.final_error - b.result.final_error) <=
           kSameError * b.result.final_error;
  }

  End EndHere(OptimizerResult result) const {
    return {std::move(result), graph_.poses, graph_.landmarks};
  }

  void GoTo(const End& end) {
    graph_.poses = end.poses;
    graph_.landmarks = end.landmarks;
  }

  const RobustLoss& loss_;
  const MinimizeStage& minimize_;
  PoseGraph<Pose>& graph_;
  OptimizerResult sum_;         // of all stages
  bool was_cancelled_ = false;  // one of them
  bool has_ended_ = false;      // there is no point in more of them
};

}  // namespace

template <typename Pose>
OptimizerResult MinimizeGraduated(const RobustLoss& loss, const MinimizeStage& minimize,
                                  PoseGraph<Pose>* graph) {
  return GraduatedDescent<Pose>(loss, minimize, graph).Run();
}

template OptimizerResult MinimizeGraduated(const RobustLoss&, const MinimizeStage&,
                                           PoseGraph<SE2>*);
template OptimizerResult MinimizeGraduated(const RobustLoss&, const MinimizeStage&,
                                           PoseGraph<SE3>*);

}  // namespace loopgrid
