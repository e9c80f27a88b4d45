#pragma once

#include <optional>

#include "backend/base/stopwatch.h"
#include "backend/graph/pose_graph.h"
#include "backend/solve/linearization.h"
#include "backend/solve/marginals.h"
#include "backend/solve/normal_equations.h"
#include "backend/solve/optimizer_options.h"
#include "backend/solve/optimizer_result.h"

namespace loopgrid {

/// Least-squares optimisation of a pose graph. Keep the object while a graph grows: memory and the
/// analysis of the structure are used again, and if the new edges add next to nothing to F, nothing
/// but F is computed. HeldNodes() do not move.
template <typename Pose>
class Optimizer {
 public:
  /// Throws Error (kUsage) if the options are not valid.
  explicit Optimizer(const OptimizerOptions& options = {});

  const OptimizerOptions& options() const { return options_; }

  /// Moves the graph's poses and landmarks from where they are to a minimum of F, or to the lowest
  /// point found if the limits end the descent before. All components of the graph are optimised.
  /// Throws Error (kInput) if the graph is not valid (see Validate). The observer is called from
  /// this thread.
  OptimizerResult Optimize(PoseGraph<Pose>* graph, const StepObserver& observer = {});

  /// Covariances of local motions (Pose::Boxplus) at the graph's poses and landmarks; nothing if
  /// the Hessian there is not positive definite. If Optimize has just been called for the same
  /// graph, its factorisation is used. The result is valid until the optimiser is used again.
  std::optional<Marginals<Pose>> ComputeMarginals(const PoseGraph<Pose>& graph);

 private:
  /// The end of the last call of Optimize.
  struct End {
    PoseGraph<Pose> graph;
    double error = 0.0;
    bool is_minimum = false;
    bool is_factored = false;  // the linearization's factor is of this graph
  };

  bool IsAtOptimum(const PoseGraph<Pose>& graph, double* error) const;

  OptimizerOptions options_;
  Linearization<Pose> linearization_;
  End end_;
};

extern template class Optimizer<SE2>;
extern template class Optimizer<SE3>;

}  // namespace loopgrid
