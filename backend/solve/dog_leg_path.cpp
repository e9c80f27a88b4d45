#include "backend/solve/dog_leg_path.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace loopgrid {
namespace {

// If F falls by more than the first share of what was promised, the next step may be longer; if by
// less than the second, it has to be shorter.
constexpr double kTrusted = 0.75;
constexpr double kDistrusted = 0.25;

}  // namespace

DogLegPath::DogLegPath(Eigen::VectorXd cauchy, Eigen::VectorXd newton, Eigen::VectorXd scale)
    : cauchy_(std::move(cauchy)), newton_(std::move(newton)), scale_(std::move(scale)) {}

Eigen::VectorXd DogLegPath::PointWithin(double radius) const {
  if (Length(newton_) <= radius) return newton_;
  const double first_leg = Length(cauchy_);
  if (first_leg >= radius) return radius / first_leg * cauchy_;
  const Eigen::VectorXd leg = newton_ - cauchy_;
  // The root of |cauchy + t leg| = radius in (0, 1], by the formula without cancellation.
  const double a = Product(leg, leg);
  const double half_b = Product(cauchy_, leg);
  const double c = radius * radius - first_leg * first_leg;
  const double root = std::sqrt(half_b * half_b + a * c);
  const double t = half_b > 0.0 ? c / (half_b + root) : (root - half_b) / a;
  return cauchy_ + t * leg;
}

double DogLegPath::Length(const Eigen::VectorXd& v) const { return std::sqrt(Product(v, v)); }

double DogLegPath::Product(const Eigen::VectorXd& v, const Eigen::VectorXd& w) const {
  return v.dot(scale_.cwiseProduct(w));
}

double NextRadius(double radius, double length, double gain) {
  if (gain < 0.0) return kDistrusted * length;
  if (gain > kTrusted) return std::max(radius, 3.0 * length);
  return gain < kDistrusted ? 0.5 * length : radius;
}

}  // namespace loopgrid
