#pragma once

#include <cassert>
#include <cstddef>
#include <type_traits>

namespace loopgrid {

/// A number of a node, variable, row, ... as the index of a standard container. It must not be
/// negative; debug builds check that.
template <typename Integer>
constexpr std::size_t ToIndex(Integer number) {
  static_assert(std::is_integral_v<Integer>);
  assert(!(number < Integer{0}));
  return static_cast<std::size_t>(number);
}

}  // namespace loopgrid
