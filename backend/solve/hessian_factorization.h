#pragma once

#include <Eigen/Core>

#include "backend/graph/pose_graph.h"
#include "backend/solve/normal_equations.h"
#include "backend/sparse/double_double.h"
#include "backend/sparse/exact_elimination.h"
#include "backend/sparse/sparse_cholesky.h"
#include "backend/sparse/symmetric_block_matrix.h"

namespace loopgrid {

/// The Hessian that the equations have after Linearize, with twice the digits. Where information
/// matrices differ by many orders of magnitude, double precision loses the weak ones in the sum.
template <typename Pose>
SymmetricBlockMatrix<Pose::kDof, DoubleDouble> ExactHessian(const PoseGraph<Pose>& graph,
                                                            const Objective& objective,
                                                            const NormalEquations<Pose>& equations);

/// Factorises the Hessian that the equations have after Linearize of this graph with this
/// objective, plus a diagonal matrix if its entries are given: in double precision, or with twice
/// the digits where that is not enough. There is a factor unless the result is kIndefinite; see
/// SparseCholesky::FactorizeExactly for semidefinite ones. `factor` has analysed the Hessian.
template <typename Pose>
[[nodiscard]] Definiteness FactorizeHessian(const PoseGraph<Pose>& graph,
                                            const Objective& objective,
                                            const NormalEquations<Pose>& equations,
                                            const Eigen::VectorXd& added,
                                            SparseCholesky<Pose::kDof>* factor);

/// For covariances, after FactorizeHessian without `added` has found the Hessian positive definite:
/// factorises it again with twice the digits, unless a bound says that rounding errors are at most
/// this share of each pivot. Steps need no such care, since the next step corrects them.
template <typename Pose>
void RefineFactor(const PoseGraph<Pose>& graph, const Objective& objective,
                  const NormalEquations<Pose>& equations, double most_noise,
                  SparseCholesky<Pose::kDof>* factor);

}  // namespace loopgrid
