#pragma once

#include <chrono>
#include <thread>

namespace loopgrid::test_support {

/// Waits until other threads or processes make a condition true. False after a time that is much
/// longer than it should take.
template <typename Condition>
bool WaitUntil(const Condition& condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace loopgrid::test_support
