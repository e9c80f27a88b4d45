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

/// Least-squares optimisation of a pose graph. Keep the object while a graph grows: what was
/// allocated and analysed is used again, and what is new costs nothing beyond a look at F as long
/// as it agrees with the rest. HeldNodes() do not move.
template <typename Pose>
class Optimizer {
 public:
  /// Throws Error (kUsage) if the options are not valid.
  explicit Optimizer(const OptimizerOptions& options = {});

  const OptimizerOptions& options() const { return options_; }

  /// Moves the graph's poses and landmarks, from where they are, to a minimum of F, or to the best
  /// point on the way. Throws Error (kInput) if the graph is not valid (see Validate); a graph with
  /// several components is optimised as such. An observer is called from this thread.
  OptimizerResult Optimize(PoseGraph<Pose>* graph, const StepObserver& observer = {});

  /// Covariances at the graph's poses and landmarks, for local motions (Pose::Boxplus); nothing if
  /// the Hessian there is not positive definite. Right after Optimize of the same graph its
  /// factorisation is used. Valid until the optimiser is used again.
  std::optional<Marginals<Pose>> ComputeMarginals(const PoseGraph<Pose>& graph);

 private:
  /// Where the last call has ended.
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
