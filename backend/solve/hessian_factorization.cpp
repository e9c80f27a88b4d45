#include "backend/solve/hessian_factorization.h"

#include <algorithm>
#include <cstddef>

#include "backend/base/index.h"
#include "backend/graph/parametrization.h"

namespace loopgrid {
namespace {

/// A^T * Omega * B.
template <int kRows, int kDof>
Eigen::Matrix<DoubleDouble, kDof, kDof> HessianProduct(
    const Eigen::Matrix<double, kRows, kDof>& A, const Eigen::Matrix<double, kRows, kRows>& Omega,
    const Eigen::Matrix<double, kRows, kDof>& B) {
  Eigen::Matrix<DoubleDouble, kDof, kDof> product;
  for (int j = 0; j < kDof; ++j) {
    Eigen::Matrix<DoubleDouble, kRows, 1> weighted;
    for (int r = 0; r < kRows; ++r) {
      DoubleDouble sum;
      for (int c = 0; c < kRows; ++c) sum += ExactProduct(Omega(r, c), B(c, j));
      weighted(r) = sum;
    }
    for (int i = 0; i < kDof; ++i) {
      DoubleDouble sum;
      for (int r = 0; r < kRows; ++r) sum += DoubleDouble(A(r, i)) * weighted(r);
      product(i, j) = sum;
    }
  }
  return product;
}

template <int kDof>
class HessianSum {
 public:
  using Matrix = SymmetricBlockMatrix<kDof, DoubleDouble>;

  /// Zeros, with the pattern of another matrix.
  explicit HessianSum(const SymmetricBlockMatrix<kDof>& pattern) {
    sum_.Resize(pattern.cols());
    for (const BlockPlace& place : pattern.places()) sum_.FindOrAddBlock(place.row, place.col);
  }

  /// Adds J^T Omega J of an edge with these Jacobians by its two ends; -1 for an end that is held.
  template <int kRows>
  void Add(int first, int second, const Eigen::Matrix<double, kRows, kDof>& J_first,
           const Eigen::Matrix<double, kRows, kDof>& J_second,
           const Eigen::Matrix<double, kRows, kRows>& Omega) {
    if (first >= 0) sum_.diagonal(first) += HessianProduct(J_first, Omega, J_first);
    if (second >= 0) sum_.diagonal(second) += HessianProduct(J_second, Omega, J_second);
    if (first < 0 || second < 0) return;
    if (first < second) {
      sum_.off_diagonal(sum_.FindOrAddBlock(first, second)) +=
          HessianProduct(J_first, Omega, J_second);
    } else {
      sum_.off_diagonal(sum_.FindOrAddBlock(second, first)) +=
          HessianProduct(J_second, Omega, J_first);
    }
  }

  Matrix& matrix() { return sum_; }

 private:
  Matrix sum_;
};

template <typename Edge>
double Weight(const Edge& edge, const RobustLoss& loss, double chi2) {
  return edge.robust ? loss.Evaluate(chi2).weight : 1.0;
}

}  // namespace

template <typename Pose>
SymmetricBlockMatrix<Pose::kDof, DoubleDouble> ExactHessian(
    const PoseGraph<Pose>& graph, const Objective& objective,
    const NormalEquations<Pose>& equations) {
  constexpr int kDof = Pose::kDof;
  constexpr int kPoint = Pose::Point::RowsAtCompileTime;
  HessianSum<kDof> sum(equations.hessian());
  for (const Constraint<Pose>& c : graph.constraints) {
    const LinearizedConstraint<Pose> linear =
        Linearize(graph.poses[ToIndex(c.from)], graph.poses[ToIndex(c.to)], c.T_from_to,
                  objective.parametrization);
    const double weight = Weight(c, objective.loss, linear.error.dot(c.information * linear.error));
    sum.template Add<kDof>(equations.variable(c.from), equations.variable(c.to), linear.J_from,
                           linear.J_to, weight * c.information);
  }
  for (const LandmarkObservation<Pose>& o : graph.observations) {
    const LinearizedObservation<Pose> linear =
        Linearize(graph.poses[ToIndex(o.node)], graph.landmarks[ToIndex(o.landmark)], o.p_node,
                  objective.parametrization);
    const double weight = Weight(o, objective.loss, linear.error.dot(o.information * linear.error));
    Eigen::Matrix<double, kPoint, kDof> J_landmark = Eigen::Matrix<double, kPoint, kDof>::Zero();
    J_landmark.template leftCols<kPoint>() = linear.J_landmark;
    sum.template Add<kPoint>(equations.variable(o.node), equations.landmark_variable(o.landmark),
                             linear.J_node, J_landmark, weight * o.information);
  }
  for (int landmark = 0; landmark < equations.landmark_count(); ++landmark) {
    const int variable = equations.landmark_variable(landmark);
    if (variable < 0) continue;
    for (int i = kPoint; i < kDof; ++i) sum.matrix().diagonal(variable)(i, i) = 1.0;
  }
  return sum.matrix();
}

template <typename Pose>
Definiteness FactorizeHessian(const PoseGraph<Pose>& graph, const Objective& objective,
                              const NormalEquations<Pose>& equations, const Eigen::VectorXd& added,
                              SparseCholesky<Pose::kDof>* factor) {
  if (factor->Factorize(equations.hessian(), added)) return Definiteness::kDefinite;
  return factor->FactorizeExactly(ExactHessian(graph, objective, equations), added);
}

template <typename Pose>
void RefineFactor(const PoseGraph<Pose>& graph, const Objective& objective,
                  const NormalEquations<Pose>& equations, double most_noise,
                  SparseCholesky<Pose::kDof>* factor) {
  if (factor->LargestNoise() <= most_noise) return;
  if (factor->FactorizeExactly(ExactHessian(graph, objective, equations)) ==
      Definiteness::kDefinite) {
    return;
  }
  // FactorizeExactly takes pivots for zero that its bounds of rounding errors, which may be far too
  // large, do not tell from zero.
  static_cast<void>(FactorizeHessian(graph, objective, equations, {}, factor));
}

#define LOOPGRID_INSTANTIATE(Pose)                                                             \
  template SymmetricBlockMatrix<Pose::kDof, DoubleDouble> ExactHessian(                        \
      const PoseGraph<Pose>&, const Objective&, const NormalEquations<Pose>&);                 \
  template Definiteness FactorizeHessian(const PoseGraph<Pose>&, const Objective&,             \
                                         const NormalEquations<Pose>&, const Eigen::VectorXd&, \
                                         SparseCholesky<Pose::kDof>*);                         \
  template void RefineFactor(const PoseGraph<Pose>&, const Objective&,                         \
                             const NormalEquations<Pose>&, double, SparseCholesky<Pose::kDof>*);
LOOPGRID_INSTANTIATE(SE2)
LOOPGRID_INSTANTIATE(SE3)
#undef LOOPGRID_INSTANTIATE

}  // namespace loopgrid
