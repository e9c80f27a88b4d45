#pragma once

#include <cstddef>

namespace loopgrid::test_support {

/// An index that is not negative, as the standard containers take it.
constexpr std::size_t Index(int i) { return static_cast<std::size_t>(i); }

}  // namespace loopgrid::test_support
