#include "frontend/matching/match_covariance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace loopgrid {
namespace {

constexpr int kHalf = 2;  // lattice points on either side of the centre, per axis
constexpr int kSide = 2 * kHalf + 1;
constexpr double kSpacing = 1.33;  // standard deviations between lattice points

// Sum of the table's values under the points placed at `pose`.
int SumOfHits(const LikelihoodTable& table, std::span<const Eigen::Vector2f> points,
              const SE2& pose) {
  const auto c = static_cast<float>(pose.cos());
  const auto s = static_cast<float>(pose.sin());
  const auto x = static_cast<float>(pose.x());
  const auto y = static_cast<float>(pose.y());
  int sum = 0;
  for (const Eigen::Vector2f& p : points) {
    sum += table.At(table.CellOf({c * p.x() - s * p.y() + x, s * p.x() + c * p.y() + y}));
  }
  return sum;
}

// Moments of the lattice's weights.
struct Moments {
  double s = 0.0;
  Eigen::Vector3d u = Eigen::Vector3d::Zero();
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();

  void Add(double weight, const Eigen::Vector3d& d) {
    s += weight;
    u += weight * d;
    K += weight * d * d.transpose();
  }
  Eigen::Matrix3d Covariance() const { return K / s - u * u.transpose() / (s * s); }
};

}  // namespace

Eigen::Matrix3d ScoreInformation(const LikelihoodTable& table,
                                 std::span<const Eigen::Vector2f> points, const SE2& T_map_robot,
                                 const Eigen::Matrix3d& shape,
                                 const MatchCovarianceOptions& options) {
  if (points.empty()) return Eigen::Matrix3d::Zero();
  double squares = 0.0;
  for (const Eigen::Vector2f& p : points) squares += static_cast<double>(p.squaredNorm());
  const double lever = std::max(std::sqrt(squares / static_cast<double>(points.size())), 0.1);

  // Principal axes. Radians are multiplied by a lever, so that they can be compared with metres:
  // the distance that a hit moves per radian.
  const Eigen::Vector3d unit(1.0, 1.0, 1.0 / lever);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(unit.asDiagonal() * shape *
                                                                 unit.asDiagonal());
  Eigen::Matrix3d axes = unit.asDiagonal() * principal.eigenvectors();  // columns, to motions
  Eigen::Vector3d spacing;
  for (int k = 0; k < 3; ++k) {
    const double sigma = 1.0 / std::sqrt(std::max(principal.eigenvalues()(k), 1e-9));
    spacing(k) = std::clamp(sigma, options.narrowest, options.widest) * kSpacing;
  }

  std::array<int, kSide * kSide * kSide> sums{};
  std::size_t at = 0;
  const auto offset = [&](int a, int b, int c) -> Eigen::Vector3d {
    return Eigen::Vector3d(a, b, c).cwiseProduct(spacing);
  };
  for (int a = -kHalf; a <= kHalf; ++a) {
    for (int b = -kHalf; b <= kHalf; ++b) {
      for (int c = -kHalf; c <= kHalf; ++c) {
        sums[at++] = SumOfHits(table, points, T_map_robot.Boxplus(axes * offset(a, b, c)));
      }
    }
  }
  const int best = *std::max_element(sums.begin(), sums.end());
  Moments weighted;
  Moments even;
  at = 0;
  for (int a = -kHalf; a <= kHalf; ++a) {
    for (int b = -kHalf; b <= kHalf; ++b) {
      for (int c = -kHalf; c <= kHalf; ++c) {
        const double weight = std::exp(options.hit_log_likelihood * (sums[at++] - best) / 255.0);
        weighted.Add(weight, offset(a, b, c));
        even.Add(1.0, offset(a, b, c));
      }
    }
  }
  // The lattice cannot resolve a peak narrower than its spacing.
  const Eigen::Vector3d grain = (0.3 * spacing).cwiseAbs2();
  const Eigen::Matrix3d covariance = weighted.Covariance() + Eigen::Matrix3d(grain.asDiagonal());
  const Eigen::Matrix3d evenly = even.Covariance() + Eigen::Matrix3d(grain.asDiagonal());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> knowledge(covariance.inverse() -
                                                                 Eigen::Matrix3d(evenly.inverse()));
  const Eigen::Matrix3d information = knowledge.eigenvectors() *
                                      knowledge.eigenvalues().cwiseMax(0.0).asDiagonal() *
                                      knowledge.eigenvectors().transpose();
  const Eigen::Matrix3d to_axes = axes.inverse();
  const Eigen::Matrix3d result = to_axes.transpose() * information * to_axes;
  return 0.5 * (result + result.transpose());
}

Eigen::Matrix3d MatchCovariance(const LikelihoodTable& table,
                                std::span<const Eigen::Vector2f> points, const RefinedMatch& match,
                                const MatchCovarianceOptions& options) {
  // The curvature of the score, if the surface of each hit is the nearest reference point.
  const double ratio = match.range_sigma / static_cast<double>(table.sigma());
  const Eigen::Matrix3d shape = options.hit_log_likelihood * ratio * ratio * match.information;
  const double translation = options.unknown_translation * options.unknown_translation;
  const double rotation = options.unknown_rotation * options.unknown_rotation;
  const Eigen::Matrix3d unknown =
      Eigen::Vector3d(translation, translation, rotation).cwiseInverse().asDiagonal();
  const Eigen::Matrix3d covariance =
      (ScoreInformation(table, points, match.T_map_robot, shape, options) + unknown).inverse() +
      (match.information + unknown).inverse();
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace loopgrid
