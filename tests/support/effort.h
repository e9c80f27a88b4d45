#pragma once

namespace loopgrid::test_support {

/// How many rounds of a repeated computation a test does: `full` in a normal build, `sanitized`
/// under a sanitizer. A sanitizer is about ten times slower and finds a defect in the first few
/// rounds.
template <typename T>
constexpr T Effort([[maybe_unused]] T full, [[maybe_unused]] T sanitized) {
#ifdef LOOPGRID_SANITIZED
  return sanitized;
#else
  return full;
#endif
}

}  // namespace loopgrid::test_support
