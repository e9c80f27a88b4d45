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

/// How steps are made of linear problems. Owns what it has learnt on the way: a damping, a radius.
template <typename Pose>
class StepMethod {
 public:
  virtual ~StepMethod() = default;

  /// Makes a step of the descent, or says why there is none.
  virtual std::optional<Termination> MakeStep(Descent<Pose>* descent) = 0;

  /// For the record.
  virtual double damping() const { return 0.0; }
};

struct DescentOptions {
  int max_iterations = 0;          ///< steps
  double relative_decrease = 0.0;  ///< see OptimizerOptions
  double absolute_decrease = 0.0;
  bool trace = false;
  StepObserver observer;  ///< none if empty
  Stopwatch watch;        ///< of IterationRecord::seconds
};

/// What became of a step that was tried.
struct Trial {
  enum class Kind { kTaken, kNegligible, kRejected };
  Kind kind;
  double gain = 0.0;  ///< decrease of F as a share of what was promised, if taken
};

/// The way of a graph from where it is down to a minimum of F: knows the current point, F there and
/// the linear problem there, keeps the best point and the trace. A StepMethod decides on the steps.
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

  /// At the current point. Its factor is whatever the method has made.
  Linearization<Pose>& linearization() { return linearization_; }
  double error() const { return result_.final_error; }  ///< F at the current point
  double negligible() const;                            ///< decrease of F at which to stop
  bool may_continue() const { return result_.iterations < options_.max_iterations; }

  /// Goes on by dx, whether F falls or not.
  void Step(const Eigen::VectorXd& dx);

  /// Goes on by dx if that lowers F; `promised` is the decrease by the quadratic model.
  Trial TryStep(const Eigen::VectorXd& dx, double promised);

  /// Notes the current point in the trace. The descent itself does so whenever a method has made a
  /// step; a method that makes several at a time does it in between.
  void Record(double damping);

  /// Where the descent may return to, as if what follows had not been.
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
  std::optional<Checkpoint> best_;  // if the descent has gone uphill since
  double last_step_ = 0.0;          // its length
};

extern template class Descent<SE2>;
extern template class Descent<SE3>;

}  // namespace loopgrid
