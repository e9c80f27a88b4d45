#include "backend/graph/robust_loss.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

constexpr LossKind kRobust[] = {LossKind::kHuber, LossKind::kCauchy, LossKind::kGemanMcClure,
                                LossKind::kDcs};

TEST(RobustLoss, QuadraticLeavesEverythingAsItIs) {
  const RobustLoss loss;
  EXPECT_EQ(loss.Evaluate(1234.5).cost, 1234.5);
  EXPECT_EQ(loss.Evaluate(1234.5).weight, 1.0);
}

TEST(RobustLoss, WeightIsTheDerivativeOfTheCost) {
  for (const LossKind kind : kRobust) {
    const RobustLoss loss{kind, 1.7};
    for (const double chi2 : {0.1, 1.0, 2.88, 2.9, 5.0, 100.0, 1e6}) {
      const double step = 1e-5 * chi2;
      const double slope =
          (loss.Evaluate(chi2 + step).cost - loss.Evaluate(chi2 - step).cost) / (2.0 * step);
      const double weight = loss.Evaluate(chi2).weight;
      EXPECT_NEAR(slope, weight, 1e-6 * weight + 1e-9) << static_cast<int>(kind) << " at " << chi2;
    }
  }
}

TEST(RobustLoss, BehavesLikeTheSquareForSmallErrors) {
  for (const LossKind kind : kRobust) {
    const RobustLoss loss{kind, 3.0};
    EXPECT_EQ(loss.Evaluate(0.0).cost, 0.0);
    EXPECT_EQ(loss.Evaluate(0.0).weight, 1.0);
    EXPECT_NEAR(loss.Evaluate(1e-6).cost, 1e-6, 1e-12);
  }
}

TEST(RobustLoss, NeverDecreasesAndNeverWeighsMoreForLargerErrors) {
  for (const LossKind kind : kRobust) {
    const RobustLoss loss{kind, 2.0};
    LossValue last = loss.Evaluate(0.0);
    for (double chi2 = 0.01; chi2 < 1e4; chi2 *= 1.1) {
      const LossValue value = loss.Evaluate(chi2);
      EXPECT_GT(value.cost, last.cost) << static_cast<int>(kind) << " at " << chi2;
      EXPECT_LE(value.weight, last.weight) << static_cast<int>(kind) << " at " << chi2;
      last = value;
    }
  }
}

TEST(RobustLoss, BoundsOfTheBoundedOnesAreAsDocumented) {
  EXPECT_NEAR((RobustLoss{LossKind::kGemanMcClure, 2.0}.Evaluate(1e9).cost), 4.0, 1e-6);
  EXPECT_NEAR((RobustLoss{LossKind::kDcs, 2.0}.Evaluate(1e9).cost), 12.0, 1e-6);
}

TEST(RobustLoss, RefusesWidthsThatAreNotPositive) {
  for (const double width : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    try {
      RobustLoss{LossKind::kHuber, width}.Validate();
      ADD_FAILURE() << "accepted " << width;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kUsage);
      EXPECT_THAT(error.what(), ::testing::HasSubstr("width"));
    }
  }
}

}  // namespace
}  // namespace loopgrid
