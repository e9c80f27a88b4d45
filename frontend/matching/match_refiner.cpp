#include "frontend/matching/match_refiner.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace loopgrid {
namespace {

struct NormalEquations {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double weighted_square = 0.0;
  double weight = 0.0;
  double weighted_lever = 0.0;  // squared distance of the hits from the robot
  int used = 0;
  int inliers = 0;
  int candidates = 0;
};

// Residuals r = n . (T p - q) at pose T, and their derivatives by a motion in the robot frame.
NormalEquations Linearize(const LocalMap& map, const PointScan& scan, const SE2& T_map_robot,
                          double scale) {
  NormalEquations equations;
  const Eigen::Matrix2f rotation = T_map_robot.rotation().cast<float>();
  const Eigen::Vector2f translation = T_map_robot.translation().cast<float>();
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.normals[i].isZero()) continue;
    ++equations.candidates;
    const Eigen::Vector2f p = rotation * scan.hits[i] + translation;
    const Surfel* surfel = map.NearestSurface(p, rotation * scan.normals[i]);
    if (surfel == nullptr) continue;
    ++equations.used;
    const double r = static_cast<double>(surfel->normal.dot(p - surfel->position));
    const double ratio = r / scale;
    const double root = 1.0 / (1.0 + ratio * ratio);
    const double w = root * root;
    const Eigen::Vector2f n = rotation.transpose() * surfel->normal;
    const Eigen::Vector2f& q = scan.hits[i];
    const Eigen::Vector3d J(static_cast<double>(n.x()), static_cast<double>(n.y()),
                            static_cast<double>(n.y() * q.x() - n.x() * q.y()));
    equations.H += w * J * J.transpose();
    equations.b += w * r * J;
    equations.weighted_square += w * r * r;
    equations.weight += w;
    equations.weighted_lever += w * static_cast<double>(q.squaredNorm());
    if (std::abs(ratio) < 1.0) ++equations.inliers;
  }
  return equations;
}

// Removes the information that comes from errors of the normals. In a corridor without features a
// normal with an error of angle e adds about sin^2(e) to the information along the corridor; a
// right normal adds nothing. In each principal direction the information that such errors explain
// is subtracted, down to zero.
void DiscountNormalErrors(double normal_sigma, NormalEquations* equations) {
  if (equations->weight <= 0.0) return;
  const double lever = std::sqrt(std::max(equations->weighted_lever / equations->weight, 1e-6));
  const Eigen::Vector3d scale(1.0, 1.0, 1.0 / lever);
  const Eigen::Matrix3d scaled = scale.asDiagonal() * equations->H * scale.asDiagonal();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(scaled);
  const double spurious = normal_sigma * normal_sigma * equations->weight;
  Eigen::Vector3d share;
  for (int k = 0; k < 3; ++k) {
    share(k) = std::max(1.0 - spurious / std::max(solver.eigenvalues()(k), 1e-12), 0.0);
  }
  const Eigen::Matrix3d keep =
      solver.eigenvectors() * share.asDiagonal() * solver.eigenvectors().transpose();
  const Eigen::Vector3d unscale = scale.cwiseInverse();
  const Eigen::Matrix3d H = unscale.asDiagonal() * (keep * scaled) * unscale.asDiagonal();
  equations->H = 0.5 * (H + H.transpose());
  equations->b = unscale.cwiseProduct(keep * scale.cwiseProduct(equations->b));
}

}  // namespace

RefinedMatch RefineMatch(const LocalMap& map, const PointScan& scan, const SE2& T_map_robot,
                         const PosePrior& prior, const RefinerOptions& options) {
  const double to_information = 1.0 / (options.range_sigma * options.range_sigma);
  SE2 pose = T_map_robot;
  double scale = options.first_scale;
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    NormalEquations equations = Linearize(map, scan, pose, scale);
    DiscountNormalErrors(options.normal_sigma, &equations);
    const SE2 off = prior.T_map_robot.Inverse() * pose;
    Eigen::Matrix3d J = Eigen::Matrix3d::Identity();  // of `off` by a motion in the robot frame
    J.topLeftCorner<2, 2>() = off.rotation();
    Eigen::Matrix3d H = to_information * equations.H + J.transpose() * prior.information * J;
    // In a direction without any information the pose stays where it is.
    H.diagonal() += Eigen::Vector3d(1e-3, 1e-3, 1e-3);
    const Eigen::Vector3d b =
        to_information * equations.b + J.transpose() * prior.information * off.coordinates();
    const Eigen::Vector3d step = -H.ldlt().solve(b);
    pose = pose.Boxplus(step);
    const bool settled = step.head<2>().norm() < 1e-4 && std::abs(step.z()) < 1e-5;
    if (settled && scale <= options.last_scale) break;
    scale = std::max(0.6 * scale, options.last_scale);
  }
  NormalEquations equations = Linearize(map, scan, pose, options.last_scale);
  DiscountNormalErrors(options.normal_sigma, &equations);
  RefinedMatch match;
  match.T_map_robot = pose;
  match.information = to_information * equations.H;
  match.range_sigma = options.range_sigma;
  match.used = equations.used;
  match.inlier_share = equations.candidates > 0
                           ? static_cast<double>(equations.inliers) / equations.candidates
                           : 0.0;
  match.residual =
      equations.weight > 0.0 ? std::sqrt(equations.weighted_square / equations.weight) : 0.0;
  return match;
}

}  // namespace loopgrid
