#include "frontend/matching/match_refiner.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace loopgrid {
namespace {

struct NormalEquations {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double weighted_square = 0.0;
  double weight = 0.0;
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
    if (std::abs(ratio) < 1.0) ++equations.inliers;
  }
  return equations;
}

}  // namespace

RefinedMatch RefineMatch(const LocalMap& map, const PointScan& scan, const SE2& T_map_robot,
                         const PosePrior& prior, const RefinerOptions& options) {
  const double to_information = 1.0 / (options.range_sigma * options.range_sigma);
  SE2 pose = T_map_robot;
  double scale = options.first_scale;
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    const NormalEquations equations = Linearize(map, scan, pose, scale);
    Eigen::Matrix3d H = to_information * equations.H + prior.information;
    // A direction that nothing speaks of stays where it is.
    H.diagonal() += Eigen::Vector3d(1e-3, 1e-3, 1e-3);
    const Eigen::Vector3d b = to_information * equations.b +
                              prior.information * pose.Boxminus(prior.T_map_robot);
    const Eigen::Vector3d step = -H.ldlt().solve(b);
    pose = pose.Boxplus(step);
    const bool settled = step.head<2>().norm() < 1e-4 && std::abs(step.z()) < 1e-5;
    if (settled && scale <= options.last_scale) break;
    scale = std::max(0.6 * scale, options.last_scale);
  }
  const NormalEquations equations = Linearize(map, scan, pose, options.last_scale);
  RefinedMatch match;
  match.T_map_robot = pose;
  match.information = to_information * equations.H;
  match.used = equations.used;
  match.inlier_share = equations.candidates > 0
                           ? static_cast<double>(equations.inliers) / equations.candidates
                           : 0.0;
  match.residual =
      equations.weight > 0.0 ? std::sqrt(equations.weighted_square / equations.weight) : 0.0;
  return match;
}

}  // namespace loopgrid
