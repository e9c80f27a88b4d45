#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "backend/marginals.h"
#include "backend/normal_equations.h"
#include "backend/pose_graph.h"
#include "backend/robust_loss.h"
#include "backend/sparse_cholesky.h"

namespace loopgrid {

struct OptimizerOptions {
  int max_iterations = 100;  ///< steps
  /// Stop when the next step promises to lower F by less than this share of F ...
  double relative_decrease = 1e-8;
  /// ... or by less than this (F counts squared standard deviations).
  double absolute_decrease = 1e-9;
  /// Of the constraints marked robust.
  RobustLoss loss;

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

enum class Termination {
  kConverged,      ///< the next step would lower F by a negligible amount
  kMaxIterations,  ///< still improving when the iterations were used up
  kStalled,        ///< no damping, however strong, found a lower F: at a numerical floor
  kIndefinite,     ///< the Hessian stays not positive definite, however strongly damped
  kNothingToMove,  ///< no node, or all of them held
};

/// One English phrase: "converged", ...
const char* ToString(Termination termination);

struct OptimizerResult {
  double initial_error = 0.0;  ///< F at the start (with the robust loss)
  double final_error = 0.0;    ///< F at the end; never more than at the start
  int iterations = 0;          ///< steps taken
  double damping = 0.0;        ///< Levenberg-Marquardt's lambda at the end; 0: Gauss-Newton
  Termination termination = Termination::kNothingToMove;
};

/// Least-squares optimisation of a pose graph on the manifold: Gauss-Newton (the tutorial's
/// Algorithm 2), and Levenberg-Marquardt whenever a Gauss-Newton step would make F worse. Keep the
/// object while a graph grows: what was allocated and analysed is used again, and a call costs one
/// linearisation and one solve when little changed. HeldNodes() do not move.
class Optimizer {
 public:
  /// Throws Error (kUsage) if the options are not valid.
  explicit Optimizer(const OptimizerOptions& options = {});

  /// Moves the graph's poses, from where they are, to a minimum of F. Throws Error (kInput) if the
  /// graph is not valid (see Validate); a graph with several components is optimised as such.
  OptimizerResult Optimize(PoseGraph* graph);

  /// Covariances of the nodes at the poses where the last call ended; nothing if the Hessian there
  /// is not positive definite. Valid until the optimiser is used again or moved.
  std::optional<Marginals> ComputeMarginals();

  /// Hessian and gradient at the poses where the last call ended.
  const NormalEquations& equations() const { return equations_; }

 private:
  enum class Step { kTaken, kNegligible, kRejected };

  void Iterate(PoseGraph* graph, OptimizerResult* result);
  /// Lowers F by one step, or says why there is none.
  std::optional<Termination> TakeStep(PoseGraph* graph, OptimizerResult* result);
  /// A step by the present factor, unless it promises more than a limit.
  Step TryStep(PoseGraph* graph, double most_promised, OptimizerResult* result);
  double Linearize(const PoseGraph& graph);
  bool Factorize(double damping);
  Eigen::VectorXd Scale() const;

  OptimizerOptions options_;
  NormalEquations equations_;
  SparseCholesky<3> factor_;
  Eigen::VectorXd damping_;         // added to the Hessian's diagonal; empty: nothing
  bool factor_is_current_ = false;  // factor_ is that of the undamped Hessian
  bool factor_fits_ = false;        // factor_ is of the last poses, and good enough for these
  double last_promised_ = 0.0;      // decrease of F, by the last step
  std::vector<SE2> poses_;          // before the step being tried; at the end, the result
};

}  // namespace loopgrid
