#include "backend/solve/linearization.h"

#include <Eigen/QR>
#include <cstddef>
#include <utility>

#include "backend/base/index.h"
#include "backend/graph/parametrization.h"
#include "backend/solve/hessian_factorization.h"

namespace loopgrid {
namespace {

constexpr double kSmallestScale = 1e-9;

/// Free directions are looked at one by one, up to this number.
constexpr int kMostFreeDirections = 64;

/// A direction is free if H is this share of what it would be there without off-diagonal entries:
/// the square of what J v may be, as a share of its terms, if it should be zero.
constexpr double kFreeCurvature = 1e-26;

/// A damping for matrices that are nearly singular: b, as far as it is made of rounding errors of
/// 1e-16, then makes steps of a hundredth of the errors at most.
constexpr double kSingularDamping = 1e-14;

/// See RefineFactor.
constexpr double kMostNoise = 1e-2;

/// v^T H v.
template <int kDof>
double ExactCurvature(const SymmetricBlockMatrix<kDof, DoubleDouble>& H, const Eigen::VectorXd& v) {
  DoubleDouble sum;
  const auto add = [&](const auto& block, int row, int col) {
    for (int i = 0; i < kDof; ++i) {
      for (int j = 0; j < kDof; ++j) {
        sum += block(i, j) * ExactProduct(v[kDof * row + i], v[kDof * col + j]);
      }
    }
  };
  for (int k = 0; k < static_cast<int>(H.places().size()); ++k) {
    const BlockPlace& place = H.places()[ToIndex(k)];
    add(H.off_diagonal(k), place.row, place.col);
  }
  sum += sum;
  for (int i = 0; i < H.cols(); ++i) add(H.diagonal(i), i, i);
  return sum.high;
}

}  // namespace

template <typename Pose>
void Linearization<Pose>::SetStructure(const PoseGraph<Pose>& graph) {
  has_undamped_factor_ = false;
  if (equations_.SetStructure(graph)) factor_.Analyze(equations_.hessian());
}

template <typename Pose>
double Linearization<Pose>::Linearize(const PoseGraph<Pose>& graph, const Objective& objective) {
  has_undamped_factor_ = false;
  free_decrease_.reset();
  graph_ = &graph;
  objective_ = objective;
  return equations_.Linearize(graph, objective, &workers_);
}

template <typename Pose>
Definiteness Linearization<Pose>::Factorize(double damping) {
  const Eigen::VectorXd scale = Scale();
  Eigen::VectorXd added = damping > 0.0 ? damping * scale : Eigen::VectorXd();
  const Definiteness result = FactorizeHessian(*graph_, objective_, equations_, added, &factor_);
  has_undamped_factor_ = result == Definiteness::kDefinite && damping == 0.0;
  free_directions_.resize(0, 0);
  free_decrease_.reset();
  if (result != Definiteness::kSemidefinite) return result;
  // The factor gives one of the minima of the model. It may be far away, but all are equally low.
  const Eigen::VectorXd step = factor_.Solve(-gradient());
  const double decrease = -gradient().dot(step);
  if (added.size() == 0) added.setZero(scale.size());
  if (HoldFreeDirections(added)) return result;
  free_directions_.resize(0, 0);
  added += kSingularDamping * scale;
  if (FactorizeHessian(*graph_, objective_, equations_, added, &factor_) ==
      Definiteness::kIndefinite) {
    return Definiteness::kIndefinite;
  }
  free_decrease_ = decrease;
  return result;
}

template <typename Pose>
bool Linearization<Pose>::HoldFreeDirections(Eigen::VectorXd added) {
  const Eigen::MatrixXd directions = factor_.FreeDirections(kMostFreeDirections);
  const Eigen::Index count = directions.cols();
  if (count == 0) return false;
  const Eigen::VectorXd scale = Scale();
  const auto H = ExactHessian(*graph_, objective_, equations_);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::VectorXd v = directions.col(k);
    const double most = kFreeCurvature * v.dot(scale.cwiseProduct(v));
    if (!(ExactCurvature<kDof>(H, v) <= most)) return false;
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(directions);
  free_directions_ = qr.householderQ() * Eigen::MatrixXd::Identity(directions.rows(), count);
  // The factor holds the variables that were eliminated last. Where a direction hardly moves one of
  // them, the rounding errors of b along the direction are multiplied by up to the inverse of that.
  // So hold those which the directions move most: by a stiffness of any size, since the solution
  // can have a zero there.
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> pivoted(free_directions_.transpose());
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index held = pivoted.colsPermutation().indices()[k];
    added[held] += scale[held];
  }
  return FactorizeHessian(*graph_, objective_, equations_, added, &factor_) ==
         Definiteness::kDefinite;
}

template <typename Pose>
Eigen::VectorXd Linearization<Pose>::Solve(const Eigen::VectorXd& v) const {
  // The factor of a semidefinite matrix gives the solution that is zero at the variables that are
  // held, which may be far longer than the shortest one.
  return OutsideFreeDirections(factor_.Solve(OutsideFreeDirections(v)));
}

template <typename Pose>
Eigen::VectorXd Linearization<Pose>::OutsideFreeDirections(Eigen::VectorXd v) const {
  if (free_directions_.cols() > 0) v -= free_directions_ * (free_directions_.transpose() * v);
  return v;
}

template <typename Pose>
Definiteness Linearization<Pose>::FactorizeForCovariances(const PoseGraph<Pose>& graph,
                                                          bool careful) {
  if (!has_undamped_factor_) {
    free_directions_.resize(0, 0);
    const Definiteness result =
        FactorizeHessian(graph, objective_, equations_, Eigen::VectorXd(), &factor_);
    has_undamped_factor_ = result == Definiteness::kDefinite;
    if (!has_undamped_factor_) return result;
  }
  if (careful) RefineFactor(graph, objective_, equations_, kMostNoise, &factor_);
  return Definiteness::kDefinite;
}

template <typename Pose>
Eigen::VectorXd Linearization<Pose>::Scale() const {
  const auto& H = equations_.hessian();
  Eigen::VectorXd scale(kDof * H.cols());
  for (int i = 0; i < H.cols(); ++i) {
    scale.segment<kDof>(kDof * i) = H.diagonal(i).diagonal();
  }
  return scale.cwiseMax(kSmallestScale * scale.maxCoeff());
}

template <typename Pose>
void Linearization<Pose>::Move(const Eigen::VectorXd& dx, Parametrization parametrization,
                               PoseGraph<Pose>* graph) const {
  for (int node = 0; node < static_cast<int>(graph->poses.size()); ++node) {
    const int variable = equations_.variable(node);
    if (variable < 0) continue;
    Pose& pose = graph->poses[ToIndex(node)];
    pose = Increment<Pose>(pose, dx.segment<kDof>(kDof * variable), parametrization);
  }
  for (int landmark = 0; landmark < static_cast<int>(graph->landmarks.size()); ++landmark) {
    const int variable = equations_.landmark_variable(landmark);
    if (variable < 0) continue;
    constexpr int kPoint = Pose::Point::RowsAtCompileTime;
    graph->landmarks[ToIndex(landmark)] += dx.segment<kPoint>(kDof * variable);
  }
}

template class Linearization<SE2>;
template class Linearization<SE3>;

}  // namespace loopgrid
