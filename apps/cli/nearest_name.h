#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace loopgrid {

/// How many letters have to be inserted, deleted, replaced or swapped with their neighbour to make
/// one word of the other (optimal string alignment).
std::size_t EditDistance(std::string_view a, std::string_view b);

/// The name that a mistyped word probably stands for: the only name that it is the beginning of (of
/// three letters or more, dashes not counted), or else the name with the least EditDistance, the
/// first of several. Empty if even that is more than a third of the word's letters away.
std::string NearestName(std::string_view word, const std::vector<std::string>& names);

}  // namespace loopgrid
