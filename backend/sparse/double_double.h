#pragma once

#include <Eigen/Core>
#include <cmath>

namespace loopgrid {

/// A number with twice the digits of double, as the sum of two doubles (Dekker 1971). About 20
/// times slower than double.
struct DoubleDouble {
  double high = 0.0;
  double low = 0.0;  ///< at most half a unit in the last place of `high`

  DoubleDouble() = default;
  DoubleDouble(double value) : high(value) {}  // NOLINT: every double is one of these
  DoubleDouble(double h, double l) : high(h), low(l) {}

  explicit operator double() const { return high; }
  DoubleDouble operator-() const { return {-high, -low}; }
};

/// The sum without any rounding (Knuth).
inline DoubleDouble ExactSum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

/// The same, if |a| >= |b|.
inline DoubleDouble ExactSumOfOrdered(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// The product without any rounding.
inline DoubleDouble ExactProduct(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = ExactSum(a.high, b.high);
  const DoubleDouble low = ExactSum(a.low, b.low);
  const DoubleDouble sum = ExactSumOfOrdered(high.high, high.low + low.high);
  return ExactSumOfOrdered(sum.high, sum.low + low.low);
}

inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }

inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble product = ExactProduct(a.high, b.high);
  return ExactSumOfOrdered(product.high, product.low + (a.high * b.low + a.low * b.high));
}

inline DoubleDouble& operator+=(DoubleDouble& a, const DoubleDouble& b) { return a = a + b; }
inline DoubleDouble& operator-=(DoubleDouble& a, const DoubleDouble& b) { return a = a - b; }
inline DoubleDouble& operator*=(DoubleDouble& a, const DoubleDouble& b) { return a = a * b; }

/// 1 / a: the double nearest to it, and a step of Newton's method.
inline DoubleDouble Reciprocal(const DoubleDouble& a) {
  const DoubleDouble first = 1.0 / a.high;
  return first + first * (DoubleDouble(1.0) - a * first);
}

}  // namespace loopgrid

/// Matrices of these can be stored, added and multiplied.
template <>
struct Eigen::NumTraits<loopgrid::DoubleDouble> : Eigen::GenericNumTraits<loopgrid::DoubleDouble> {
  enum { IsComplex = 0, IsInteger = 0, IsSigned = 1, RequireInitialization = 1 };
  enum { ReadCost = 2, AddCost = 20, MulCost = 20 };
};
