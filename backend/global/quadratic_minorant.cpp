#include "backend/global/quadratic_minorant.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "backend/base/index.h"
#include "backend/graph/constraint_error.h"

namespace loopgrid {
namespace {

/// Added to information matrices, as a share, where they must be regular.
constexpr double kRegular = 1e-12;

/// In 2D, radians: beyond it an angle has no useful minorant that touches.
constexpr double kLargestAngle = std::numbers::pi - 1e-3;

template <typename Derived>
double SmallestEigenvalue(const Eigen::MatrixBase<Derived>& matrix) {
  const Eigen::SelfAdjointEigenSolver<typename Derived::PlainObject> solver(matrix,
                                                                            Eigen::EigenvaluesOnly);
  return std::max(0.0, solver.eigenvalues()[0]);
}

/// The share of an information matrix's translational and rotational blocks that is left when their
/// correlation is paid for: information >= share * (the two blocks alone).
template <int kDim, int kDof>
double UncorrelatedShare(const Eigen::Matrix<double, kDof, kDof>& information) {
  Eigen::Matrix<double, kDof, kDof> blocks = information;
  blocks.template topRightCorner<kDim, kDof - kDim>().setZero();
  blocks.template bottomLeftCorner<kDof - kDim, kDim>().setZero();
  if (blocks == information) return 1.0;
  blocks.diagonal().array() += kRegular * information.diagonal().maxCoeff();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix<double, kDof, kDof>> solver(
      information, blocks, Eigen::EigenvaluesOnly);
  return std::clamp(solver.eigenvalues()[0], 0.0, 1.0);
}

/// Of omega * theta^2 + 2 * slope * theta, theta being the angle of R_measured^T * P: up to a
/// constant omega * psi^2 with psi = theta + slope / omega. The square of an angle is a convex
/// function of minus its cosine, so the tangent there is below it. False near half a turn, where
/// that is too steep.
bool MinorizeRotation(const SE2& measured, const SE2::Tangent& error, double omega, double slope,
                      MinorantOf3dRotation /*kind*/, QuadraticMinorant<SE2>* minorant) {
  if (omega <= 0.0) return slope == 0.0;
  const double shift = slope / omega;
  const double psi = error.z() + shift;
  if (std::abs(psi) > kLargestAngle) return false;
  const double psi_over_sine = std::abs(psi) < 1e-6 ? 1.0 : psi / std::sin(psi);
  minorant->M = -0.5 * omega * psi_over_sine * SE2(0.0, 0.0, measured.theta() - shift).rotation();
  return true;
}

/// Of q^T * omega * q + 2 * slope^T * q, (w, q) being the quaternion of E = R_measured^T * P, w >=
/// 0. The first term is tr((E - I) W (E - I)^T) with W = tr(omega) / 8 I - omega / 4, and w * q is
/// linear in E.
bool MinorizeRotation(const SE3& measured, const SE3::Tangent& error, Eigen::Matrix3d omega,
                      const Eigen::Vector3d& slope, MinorantOf3dRotation kind,
                      QuadraticMinorant<SE3>* minorant) {
  const SE3 E(error);
  const Eigen::Vector3d q = E.quaternion().vec();
  // slope^T q >= slope^T (w q) - |slope| |q|^2, since 1 - w <= |q|^2 and |q| <= 1.
  const double loss = slope.norm();
  minorant->slack = 2.0 * slope.dot(q) * (1.0 - E.quaternion().w()) + 2.0 * loss * q.squaredNorm();
  omega.diagonal().array() -= 2.0 * loss;
  Eigen::Matrix3d W = omega.trace() / 8.0 * Eigen::Matrix3d::Identity() - omega / 4.0;
  if (kind == MinorantOf3dRotation::kConvex) {
    // Without b (u^T q')^2, q' being the vector part for E^-1 * (the rotation): that is nowhere
    // negative, and zero with its derivatives at E.
    const Eigen::Matrix3d product = W * E.rotation();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(0.5 *
                                                                (product + product.transpose()));
    const double b_over_8 = std::max(0.0, -solver.eigenvalues()[0]);
    const Eigen::Vector3d u = solver.eigenvectors().col(0);
    W -= b_over_8 * E.rotation() * (Eigen::Matrix3d::Identity() - 2.0 * u * u.transpose());
  }
  minorant->M = measured.rotation() * (0.25 * Skew(slope) - W);
  return true;
}

/// A 1x1 matrix as a number, others as they are.
template <typename Derived>
auto Part(const Eigen::MatrixBase<Derived>& part) {
  if constexpr (Derived::SizeAtCompileTime == 1) {
    return part.value();
  } else {
    return part.eval();
  }
}

}  // namespace

template <typename Pose>
QuadraticMinorant<Pose> Minorize(const PoseGraph<Pose>& graph, const Constraint<Pose>& c,
                                 MinorantOf3dRotation kind) {
  constexpr int kDim = QuadraticMinorant<Pose>::kDim;
  constexpr int kTurns = Pose::kDof - kDim;
  const typename Pose::Tangent error =
      ConstraintError(graph.poses[ToIndex(c.from)], graph.poses[ToIndex(c.to)], c.T_from_to);
  // Omega = (alpha I, omega) + a rest that is positive semi-definite, so that it is above its
  // tangent, which is linear in the error.
  const double share = UncorrelatedShare<kDim, Pose::kDof>(c.information);
  const double alpha =
      share * SmallestEigenvalue(c.information.template topLeftCorner<kDim, kDim>().eval());
  const Eigen::Matrix<double, kTurns, kTurns> omega =
      share * c.information.template bottomRightCorner<kTurns, kTurns>();
  typename Pose::Tangent slope = c.information * error;
  slope.template head<kDim>() -= alpha * error.template head<kDim>();
  slope.template tail<kTurns>() -= omega * error.template tail<kTurns>();

  QuadraticMinorant<Pose> minorant;
  const auto minorize_rotation = [&] {
    return MinorizeRotation(c.T_from_to, error, Part(omega), Part(slope.template tail<kTurns>()),
                            kind, &minorant);
  };
  if (!minorize_rotation()) {
    // 0 is below the rest, too; and below the rotational part.
    minorant.slack = error.dot(slope);
    slope.setZero();
    const auto turn = error.template tail<kTurns>();
    if (!minorize_rotation()) minorant.slack += turn.dot(omega * turn);
  }
  minorant.alpha = alpha;
  minorant.beta =
      c.T_from_to.rotation() * slope.template head<kDim>() - alpha * c.T_from_to.translation();
  return minorant;
}

template <typename Pose>
QuadraticMinorant<Pose> Minorize(const PoseGraph<Pose>& graph,
                                 const LandmarkObservation<Pose>& observation) {
  const typename Pose::Point error =
      ObservationError(graph.poses[ToIndex(observation.node)],
                       graph.landmarks[ToIndex(observation.landmark)], observation.p_node);
  QuadraticMinorant<Pose> minorant;
  minorant.alpha = SmallestEigenvalue(observation.information);
  minorant.beta = observation.information * error - minorant.alpha * (error + observation.p_node);
  return minorant;
}

#define LOOPGRID_INSTANTIATE(Pose)                                                           \
  template QuadraticMinorant<Pose> Minorize(const PoseGraph<Pose>&, const Constraint<Pose>&, \
                                            MinorantOf3dRotation);                           \
  template QuadraticMinorant<Pose> Minorize(const PoseGraph<Pose>&,                          \
                                            const LandmarkObservation<Pose>&);
LOOPGRID_INSTANTIATE(SE2)
LOOPGRID_INSTANTIATE(SE3)
#undef LOOPGRID_INSTANTIATE

}  // namespace loopgrid
