#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "backend/base/stopwatch.h"
#include "backend/graph/pose_graph.h"
#include "backend/solve/linearization.h"
#include "backend/solve/normal_equations.h"
#include "backend/solve/optimizer_result.h"

namespace loopgrid {

template <typename Pose>
class Descent;

/// Decides on the steps of a descent. Keeps what it needs from one step to the next, such as a
/// damping or a radius.
template <typename Pose>
class StepMethod {
 public:
  virtual ~StepMethod() = default;

  /// Makes a step of the descent, or says why there is none.
  virtual std::optional<Termination> MakeStep(Descent<Pose>* descent) = 0;

  /// The present damping, for the trace; 0 for methods without one.
  virtual double damping() const { return 0.0; }
};

struct DescentOptions {
  int max_iterations = 0;          ///< steps
  double relative_decrease = 0.0;  ///< see OptimizerOptions
  double absolute_decrease = 0.0;
  bool trace = false;
  StepObserver observer;  ///< none if empty
  Stopwatch watch;        ///< measures IterationRecord::seconds
};

/// The outcome of a step that was tried.
struct Trial {
  enum class Kind { kTaken, kNegligible, kRejected };
  Kind kind;
  double gain = 0.0;  ///< if taken: decrease of F, divided by the decrease that was promised
};

/// Moves a graph step by step towards a minimum of F. Knows the current point, F and the linear
/// problem there; keeps the best point and the trace. A StepMethod decides on the steps.
template <typename Pose>
class Descent {
 public:
  /// `linearization` has the graph's structure.
  Descent(const Objective& objective, const DescentOptions& options,
          Linearization<Pose>* linearization, PoseGraph<Pose>* graph)
      : objective_(objective), options_(options), linearization_(*linearization), graph_(*graph) {}

  /// Steps until the method, the limits or the observer end it. Leaves the graph at the best point.
  OptimizerResult Run(StepMethod<Pose>* method);

  // For methods:

  /// The linear problem at the current point. The method makes its factor.
  Linearization<Pose>& linearization() { return linearization_; }
  double error() const { return result_.final_error; }  ///< F at the current point
  double negligible() const;                            ///< decrease of F at which to stop
  bool may_continue() const { return result_.iterations < options_.max_iterations; }

  /// Moves the graph by dx, whether F falls or not.
  void Step(const Eigen::VectorXd& dx);

  /// Moves the graph by dx if that lowers F. `promised` is the decrease that the quadratic model
  /// predicts.
  Trial TryStep(const Eigen::VectorXd& dx, double promised);

  /// Adds the current point to the trace. The descent does so after each MakeStep; a method that
  /// makes several steps in one MakeStep calls this after each of them but the last.
  void Record(double damping);

  /// A point to which the descent can return. The steps since then are then neither counted nor in
  /// the trace.
  struct Checkpoint {
    std::vector<Pose> poses;
    std::vector<typename Pose::Point> landmarks;
    double error;
    int iterations;
    int uphill_steps;
    std::size_t records;
  };
  Checkpoint Save() const;
  void ReturnTo(const Checkpoint& checkpoint);

 private:
  void Restore(const Checkpoint& checkpoint);
  void Count(double error, const Eigen::VectorXd& dx);

  const Objective& objective_;
  const DescentOptions& options_;
  Linearization<Pose>& linearization_;
  PoseGraph<Pose>& graph_;
  OptimizerResult result_;
  std::optional<Checkpoint> best_;  // the lowest point before a step that did not lower F
  double last_step_ = 0.0;          // length of the last step
};

extern template class Descent<SE2>;
extern template class Descent<SE3>;

}  // namespace loopgrid
