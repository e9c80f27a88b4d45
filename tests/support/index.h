#pragma once

#include <cstddef>

namespace loopgrid::test_support {

/// An index, 0 or larger, as the type that standard containers use.
constexpr std::size_t Index(int i) { return static_cast<std::size_t>(i); }

}  // namespace loopgrid::test_support
