#include "frontend/evaluation/error_summary.h"

#include <gtest/gtest.h>

#include <cmath>

namespace loopgrid {
namespace {

TEST(Summarize, GivesTheMomentsByHand) {
  const ErrorSummary summary = Summarize({4.0, 1.0, 3.0, 2.0, 10.0});
  EXPECT_EQ(summary.count, 5U);
  EXPECT_NEAR(summary.mean, 4.0, 1e-12);
  EXPECT_NEAR(summary.standard_deviation, std::sqrt(10.0), 1e-12);
  EXPECT_NEAR(summary.squared_mean, 26.0, 1e-12);
  EXPECT_NEAR(summary.rms, std::sqrt(26.0), 1e-12);
  EXPECT_EQ(summary.median, 3.0);
  EXPECT_EQ(summary.maximum, 10.0);
}

TEST(Summarize, TheMedianOfAnEvenCountLiesBetweenTheMiddleTwo) {
  EXPECT_EQ(Summarize({4.0, 1.0, 3.0, 2.0}).median, 2.5);
  EXPECT_EQ(Summarize({1.0, 3.0}).median, 2.0);
}

TEST(Summarize, OfOneAndOfNothing) {
  EXPECT_EQ(Summarize({2.0}).median, 2.0);
  EXPECT_EQ(Summarize({2.0}).standard_deviation, 0.0);
  const ErrorSummary none = Summarize({});
  EXPECT_EQ(none.count, 0U);
  EXPECT_EQ(none.mean, 0.0);
  EXPECT_EQ(none.maximum, 0.0);
}

TEST(Summarize, DoesNotDependOnTheOrder) {
  const ErrorSummary a = Summarize({0.1, 0.7, 0.3, 1e6, 0.2});
  const ErrorSummary b = Summarize({1e6, 0.2, 0.1, 0.3, 0.7});
  EXPECT_EQ(a.mean, b.mean);
  EXPECT_EQ(a.standard_deviation, b.standard_deviation);
}

}  // namespace
}  // namespace loopgrid
