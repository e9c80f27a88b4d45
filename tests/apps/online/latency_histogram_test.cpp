#include "apps/online/latency_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/portable_random.h"

namespace loopgrid {
namespace {

TEST(LatencyHistogram, QuantilesAreThoseOfTheSortedDurations) {
  test_support::PortableRandom random(7);
  LatencyHistogram histogram;
  std::vector<double> all;
  for (int i = 0; i < 20'000; ++i) {
    all.push_back(std::pow(10.0, random.Uniform(-5.5, 2.0)));
    histogram.Add(all.back());
  }
  std::sort(all.begin(), all.end());
  for (const double quantile : {0.1, 0.5, 0.9, 0.99, 0.999}) {
    const double expected = all[static_cast<std::size_t>(std::ceil(quantile * 20'000.0)) - 1];
    EXPECT_NEAR(histogram.Quantile(quantile) / expected, 1.0, 0.021) << quantile;
  }
  EXPECT_EQ(histogram.max(), all.back());
  EXPECT_EQ(histogram.Quantile(1.0), all.back());
  EXPECT_EQ(histogram.count(), 20'000);
}

TEST(LatencyHistogram, TakesDurationsBeyondItsBins) {
  LatencyHistogram histogram;
  EXPECT_EQ(histogram.Quantile(0.5), 0.0);
  histogram.Add(-1.0);
  histogram.Add(0.0);
  EXPECT_LE(histogram.Quantile(0.5), 1e-6);
  for (int i = 0; i < 3; ++i) histogram.Add(1e9);
  EXPECT_GT(histogram.Quantile(0.99), 1800.0);
  EXPECT_EQ(histogram.max(), 1e9);
}

}  // namespace
}  // namespace loopgrid
