#include "backend/graph/robust_loss.h"

#include <fmt/format.h>

#include <cmath>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

// Between these, the fourth power of a width is a number.
constexpr double kSmallestWidth = 1e-50;
constexpr double kLargestWidth = 1e50;

}  // namespace

LossValue RobustLoss::Evaluate(double chi2) const {
  const double k2 = width * width;
  switch (kind) {
    case LossKind::kQuadratic:
      break;
    case LossKind::kHuber: {
      if (chi2 <= k2) break;
      const double distance = std::sqrt(chi2);
      return {2.0 * width * distance - k2, width / distance};
    }
    case LossKind::kCauchy:
      return {k2 * std::log1p(chi2 / k2), k2 / (k2 + chi2)};
    case LossKind::kGemanMcClure: {
      const double ratio = k2 / (k2 + chi2);
      return {chi2 * ratio, ratio * ratio};
    }
    case LossKind::kDcs: {
      if (chi2 <= k2) break;
      const double scale = 2.0 * k2 / (k2 + chi2);
      return {k2 * (3.0 * chi2 - k2) / (k2 + chi2), scale * scale};
    }
  }
  return {chi2, 1.0};
}

void RobustLoss::Validate() const {
  if (width >= kSmallestWidth && width <= kLargestWidth) return;
  throw Error(ErrorCode::kUsage, fmt::format("robust loss width is {}, expected {} to {}", width,
                                             kSmallestWidth, kLargestWidth));
}

}  // namespace loopgrid
