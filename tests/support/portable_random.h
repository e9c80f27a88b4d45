#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

namespace loopgrid::test_support {

/// Random numbers that are the same with every compiler and library: std::mt19937 is specified to
/// the bit, the distributions of <random> are not.
class PortableRandom {
 public:
  explicit PortableRandom(std::uint32_t seed) : engine_(seed) {}

  /// In [0, 1).
  double Uniform() { return static_cast<double>(engine_()) / 4294967296.0; }

  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }

  /// One of 0 .. count - 1.
  std::size_t Index(std::size_t count) {
    return static_cast<std::size_t>(Uniform() * static_cast<double>(count));
  }

  /// Nearly normal with mean 0 and deviation 1: the sum of twelve uniform numbers, which needs no
  /// function that libraries round differently. Never beyond 6.
  double Normal() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += Uniform();
    return sum;
  }

 private:
  std::mt19937 engine_;
};

}  // namespace loopgrid::test_support
