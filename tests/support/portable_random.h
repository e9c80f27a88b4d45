#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

namespace loopgrid::test_support {

/// Random numbers that are the same with every compiler and library. The standard specifies
/// std::mt19937 exactly, but not the distributions of <random>.
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

  /// Nearly normal with mean 0 and standard deviation 1, within -6..6. It is the sum of twelve
  /// uniform numbers, because libraries round functions such as log() differently.
  double Normal() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += Uniform();
    return sum;
  }

 private:
  std::mt19937 engine_;
};

}  // namespace loopgrid::test_support
