#pragma once

#include <Eigen/Core>
#include <optional>

#include "backend/base/worker_pool.h"
#include "backend/graph/pose_graph.h"
#include "backend/solve/marginals.h"
#include "backend/solve/normal_equations.h"
#include "backend/sparse/exact_elimination.h"
#include "backend/sparse/sparse_cholesky.h"

namespace loopgrid {

/// The linear problem H dx = -b at one point of a graph, and the factor that solves it. There are
/// three stages, each of which needs the one before: SetStructure after edges, nodes or held nodes
/// have changed; Linearize after poses or the objective have changed; Factorize after H or the
/// damping has changed. Memory and the analysis of the structure are used again.
template <typename Pose>
class Linearization {
 public:
  static constexpr int kDof = Pose::kDof;

  /// `threads` is used to linearise large graphs; the result does not depend on it.
  explicit Linearization(int threads) : workers_(threads) {}

  void SetStructure(const PoseGraph<Pose>& graph);

  /// Computes H and b at the graph's poses and landmarks; returns F. The graph must exist, with the
  /// same poses and landmarks, whenever Factorize is called.
  double Linearize(const PoseGraph<Pose>& graph, const Objective& objective);

  /// Factorises H + damping * diag(Scale()). There is a factor unless the result is kIndefinite. If
  /// it is kSemidefinite, there are directions that F does not depend on, or hardly; Solve, and
  /// with it Step, leaves them out, or a damping keeps it from going far along them.
  [[nodiscard]] Definiteness Factorize(double damping);

  /// Factorises H, unless the factor is that of H already; if `careful`, with twice the digits
  /// where rounding errors might reach a hundredth of a pivot. The graph is that of the last
  /// Linearize, or equal to it.
  [[nodiscard]] Definiteness FactorizeForCovariances(const PoseGraph<Pose>& graph, bool careful);

  /// Whether the factor is that of H, positive definite and without damping, where it was
  /// linearised last.
  bool has_undamped_factor() const { return has_undamped_factor_; }
  void InvalidateFactor() { has_undamped_factor_ = false; }

  /// (H + damping * diag(Scale()))^-1 * v by the last factor, which may be of an earlier point. By
  /// the pseudo-inverse if that matrix was only semidefinite.
  Eigen::VectorXd Solve(const Eigen::VectorXd& v) const;
  /// Solve(-b).
  Eigen::VectorXd Step() const { return Solve(-gradient()); }

  /// How far the quadratic model without any damping is above its minimum, after Factorize(0) at
  /// this point, of which `step` is the Step().
  double UndampedDecrease(const Eigen::VectorXd& step) const {
    return free_decrease_.value_or(-gradient().dot(step));
  }

  const Eigen::VectorXd& gradient() const { return equations_.gradient(); }  ///< b, half of F'

  /// v^T H v.
  double Curvature(const Eigen::VectorXd& v) const { return v.dot(equations_.hessian() * v); }

  /// The Hessian's diagonal (Marquardt's scaling). Entries near zero, of directions that no
  /// constraint says anything about, are replaced by a small positive number.
  Eigen::VectorXd Scale() const;

  /// How close to singular the factorised matrix is, see SparseCholesky::smallest_pivot.
  double smallest_pivot() const { return factor_.smallest_pivot(); }

  int variable_count() const { return equations_.variable_count(); }

  /// Moves the graph's poses and landmarks by increments of the variables.
  void Move(const Eigen::VectorXd& dx, Parametrization parametrization,
            PoseGraph<Pose>* graph) const;

  /// The covariances at the point; requires has_undamped_factor(). They refer to this object and
  /// are valid until it is used again.
  Marginals<Pose> ComputeMarginals(const PoseGraph<Pose>& graph) const {
    return Marginals<Pose>(graph, equations_, factor_, objective_.loss);
  }

 private:
  /// After the factor of a semidefinite matrix: finds the directions that F does not depend on, and
  /// makes a factor that holds them and gives solutions with few rounding errors. `added` is what
  /// was added to the diagonal. False if some of the directions are not quite free.
  bool HoldFreeDirections(Eigen::VectorXd added);

  /// v without what it has along the free directions.
  Eigen::VectorXd OutsideFreeDirections(Eigen::VectorXd v) const;

  WorkerPool workers_;
  NormalEquations<Pose> equations_;
  SparseCholesky<kDof> factor_;
  const PoseGraph<Pose>* graph_ = nullptr;  // that was linearised
  Objective objective_;                     // with which it was
  bool has_undamped_factor_ = false;
  std::optional<double> free_decrease_;  // UndampedDecrease, if another damping had to be added
  Eigen::MatrixXd free_directions_;  // orthonormal columns that the factorised matrix maps to zero
};

extern template class Linearization<SE2>;
extern template class Linearization<SE3>;

}  // namespace loopgrid
