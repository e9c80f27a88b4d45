#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace loopgrid {

/// Number of letters that have to be inserted, deleted, replaced or swapped with their neighbour to
/// change one word into the other (optimal string alignment).
std::size_t EditDistance(std::string_view a, std::string_view b);

/// The name that a mistyped word probably stands for. If the word has at least three letters
/// (dashes not counted) and exactly one name begins with it, that name. Otherwise the name with the
/// least EditDistance; of several, the first. Empty if that distance is more than a third of the
/// word's letters.
std::string NearestName(std::string_view word, const std::vector<std::string>& names);

}  // namespace loopgrid
