#include "backend/sparse/double_double.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

namespace loopgrid {
namespace {

using DoubleDoubleInteger = __int128;

/// The exact value of a number that is an integer.
DoubleDoubleInteger ValueOf(const DoubleDouble& a) {
  return static_cast<DoubleDoubleInteger>(a.high) + static_cast<DoubleDoubleInteger>(a.low);
}

TEST(DoubleDouble, ComputesWithIntegersOfAHundredBits) {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::int64_t> half(-(1LL << 49), 1LL << 49);
  const auto number = [&] {
    const auto a = static_cast<double>(half(random));
    const auto b = static_cast<double>(half(random));
    return ExactSum(a * 1099511627776.0, b);  // 2^40
  };
  for (int k = 0; k < 10000; ++k) {
    const DoubleDouble a = number();
    const DoubleDouble b = number();
    EXPECT_TRUE(ValueOf(a + b) == ValueOf(a) + ValueOf(b)) << k;
    EXPECT_TRUE(ValueOf(a - b) == ValueOf(a) - ValueOf(b)) << k;
    EXPECT_TRUE(ValueOf(-a) == -ValueOf(a)) << k;
    const auto x = static_cast<double>(half(random));
    const auto y = static_cast<double>(half(random));
    EXPECT_TRUE(ValueOf(ExactProduct(x, y)) ==
                static_cast<DoubleDoubleInteger>(x) * static_cast<DoubleDoubleInteger>(y))
        << k;
    EXPECT_TRUE(ValueOf(DoubleDouble(x) * DoubleDouble(y)) ==
                static_cast<DoubleDoubleInteger>(x) * static_cast<DoubleDoubleInteger>(y))
        << k;
  }
}

TEST(DoubleDouble, KeepsWhatDoubleLoses) {
  const DoubleDouble sum = DoubleDouble(1e12) + DoubleDouble(1e-10);
  EXPECT_EQ(static_cast<double>(sum), 1e12);
  EXPECT_NEAR(static_cast<double>(sum - DoubleDouble(1e12)), 1e-10, 1e-20);
}

TEST(DoubleDouble, ProductsOfRationalNumbersAreDistributive) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 1000; ++k) {
    const DoubleDouble a = ExactSum(normal(random), 1e-17 * normal(random));
    const DoubleDouble b = ExactSum(normal(random), 1e-17 * normal(random));
    const DoubleDouble c = ExactSum(normal(random), 1e-17 * normal(random));
    const double size = std::abs(a.high * b.high) + std::abs(a.high * c.high) + std::abs(a.high);
    const DoubleDouble difference = a * (b + c) - (a * b + a * c);
    EXPECT_LE(std::abs(difference.high), 1e-30 * size) << k;
    const DoubleDouble one = a * Reciprocal(a);
    EXPECT_LE(std::abs((one - DoubleDouble(1.0)).high), 1e-30) << k;
  }
}

}  // namespace
}  // namespace loopgrid
