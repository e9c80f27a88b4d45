#pragma once

namespace loopgrid {

/// What replaces the square of a constraint's error so that a wrong one pulls less.
enum class LossKind {
  kQuadratic,     ///< rho(s) = s
  kHuber,         ///< grows like the error, not its square, beyond the width
  kCauchy,        ///< grows like a logarithm
  kGemanMcClure,  ///< bounded by width^2
  kDcs,           ///< dynamic covariance scaling (Agarwal et al. 2013): bounded by 3 width^2
};

/// rho(s) and its derivative, which is the weight of the constraint in the next iteration.
struct LossValue {
  double cost;
  double weight;
};

/// A robust loss as a function of s = e^T * Omega * e. Within the width, which counts in standard
/// deviations, it is close to s.
struct RobustLoss {
  LossKind kind = LossKind::kQuadratic;
  double width = 3.0;  ///< standard deviations

  LossValue Evaluate(double chi2) const;

  /// Throws Error (kUsage) naming the field, its value and its bound.
  void Validate() const;
};

}  // namespace loopgrid
