#pragma once

#include <Eigen/Core>
#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

#include "backend/base/worker_pool.h"
#include "backend/graph/pose_graph.h"
#include "backend/solve/marginals.h"
#include "backend/solve/normal_equations.h"
#include "backend/solve/optimizer_options.h"
#include "backend/sparse/sparse_cholesky.h"

namespace loopgrid {

enum class Termination {
  kConverged,      ///< the next step would lower F by a negligible amount
  kMaxIterations,  ///< still improving when the iterations were used up
  kStalled,        ///< no step, however short, found a lower F: at a numerical floor
  kDiverged,       ///< Gauss-Newton ended higher than where it had been
  kIndefinite,     ///< the Hessian is not positive definite, or stays so however strongly damped
  kNothingToMove,  ///< no node, or all of them held
};

/// One English phrase: "converged", ...
const char* ToString(Termination termination);

/// The state after a step.
struct IterationRecord {
  double error = 0.0;    ///< F
  double chi2 = 0.0;     ///< TotalChi2, which is F but for robust losses and Euler angles
  double damping = 0.0;  ///< Levenberg-Marquardt's lambda
  double step = 0.0;     ///< length of the increment, all variables together
  double seconds = 0.0;  ///< since the call
};

struct OptimizerResult {
  double initial_error = 0.0;  ///< F at the start (with the robust loss)
  double final_error = 0.0;    ///< F at the end; never more than at the start
  int iterations = 0;          ///< steps taken
  int uphill_steps = 0;        ///< of these, those that made F worse, on the way to better ones
  double damping = 0.0;        ///< Levenberg-Marquardt's lambda at the end; 0: Gauss-Newton
  Termination termination = Termination::kNothingToMove;
  std::vector<IterationRecord> trace;  ///< the start and every step
};

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
  /// several components is optimised as such.
  OptimizerResult Optimize(PoseGraph<Pose>* graph);

  /// Covariances at the graph's poses and landmarks, for local motions (Pose::Boxplus); nothing if
  /// the Hessian there is not positive definite. Right after Optimize of the same graph its
  /// factorisation is used. Valid until the optimiser is used again.
  std::optional<Marginals<Pose>> ComputeMarginals(const PoseGraph<Pose>& graph);

 private:
  static constexpr int kDof = Pose::kDof;
  enum class Trial { kTaken, kNegligible, kRejected };
  struct State {
    std::vector<Pose> poses;
    std::vector<typename Pose::Point> landmarks;
  };
  /// The end of a call.
  struct End {
    bool is_minimum = false;
    double error = 0.0;
    PoseGraph<Pose> graph;
  };

  OptimizerResult Minimize(PoseGraph<Pose>* graph);
  OptimizerResult MinimizeGraduated(PoseGraph<Pose>* graph);
  bool IsAtOptimum(const PoseGraph<Pose>& graph, double* error) const;
  void SetStructure(const PoseGraph<Pose>& graph);
  void Iterate(PoseGraph<Pose>* graph, OptimizerResult* result);
  /// Make one step, or say why there is none.
  std::optional<Termination> TakeStep(PoseGraph<Pose>* graph, OptimizerResult* result);
  std::optional<Termination> GaussNewtonStep(PoseGraph<Pose>* graph, OptimizerResult* result);
  std::optional<Termination> LevenbergMarquardtStep(PoseGraph<Pose>* graph,
                                                    OptimizerResult* result);
  std::optional<Termination> DogLegStep(PoseGraph<Pose>* graph, OptimizerResult* result);
  /// Full steps, the first of which raises F, if a few of them lower it in the end.
  bool LookAhead(PoseGraph<Pose>* graph, OptimizerResult* result);
  /// A step by the present factor, unless it promises more than a limit.
  Trial TryFactor(PoseGraph<Pose>* graph, double most_promised, OptimizerResult* result);
  /// Moves the graph by `dx` if that lowers F; `promised` is what the quadratic model says it does.
  Trial TryStep(PoseGraph<Pose>* graph, const Eigen::VectorXd& dx, double promised,
                OptimizerResult* result);
  void Move(PoseGraph<Pose>* graph, const Eigen::VectorXd& dx) const;
  static State StateOf(const PoseGraph<Pose>& graph) { return {graph.poses, graph.landmarks}; }
  static void Restore(const State& state, PoseGraph<Pose>* graph);
  double Linearize(const PoseGraph<Pose>& graph);
  bool Factorize(double damping);
  Eigen::VectorXd Scale() const;
  double Negligible(const OptimizerResult& result) const;
  void Record(const PoseGraph<Pose>& graph, OptimizerResult* result);

  OptimizerOptions options_;
  Objective objective_;
  WorkerPool workers_;
  NormalEquations<Pose> equations_;
  SparseCholesky<kDof> factor_;
  Eigen::VectorXd damping_;         // added to the Hessian's diagonal; empty: nothing
  bool factor_is_current_ = false;  // factor_ is of the undamped Hessian of the last call's graph
  bool factor_fits_ = false;        // factor_ is of the last point, and good enough for this one
  double last_promised_ = 0.0;      // decrease of F, by the last step
  double last_gain_ = 0.0;          // the share of that which came true
  double last_step_ = 0.0;          // its length
  int failed_trials_ = 0;           // of looking ahead, in a row
  double radius_ = 0.0;             // of the dog leg's trust region
  State before_;                    // the step being tried
  std::chrono::steady_clock::time_point start_;  // of the call
  End end_;                                      // of the last call
};

extern template class Optimizer<SE2>;
extern template class Optimizer<SE3>;

}  // namespace loopgrid
