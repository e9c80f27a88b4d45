#include "apps/cli/nearest_name.h"

#include <algorithm>
#include <numeric>

namespace loopgrid {
namespace {

std::string_view WithoutDashes(std::string_view name) {
  return name.substr(std::min(name.find_first_not_of('-'), name.size()));
}

/// The only name that begins with `word`; empty if there is none or more than one.
std::string NameBeginningWith(std::string_view word, const std::vector<std::string>& names) {
  constexpr std::size_t kShortest = 3;
  if (word.size() < kShortest) return "";
  std::string found;
  for (const std::string& name : names) {
    if (!WithoutDashes(name).starts_with(word)) continue;
    if (!found.empty()) return "";
    found = name;
  }
  return found;
}

}  // namespace

std::size_t EditDistance(std::string_view a, std::string_view b) {
  // Rows of the table of distances between the beginnings of both words.
  std::vector<std::size_t> before_last(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last = last;
    last = row;
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row.back();
}

std::string NearestName(std::string_view word, const std::vector<std::string>& names) {
  const std::string_view letters = WithoutDashes(word);
  if (std::string name = NameBeginningWith(letters, names); !name.empty()) return name;
  std::string nearest;
  std::size_t least = std::max<std::size_t>(letters.size() / 3, 1) + 1;
  for (const std::string& name : names) {
    const std::size_t distance = EditDistance(letters, WithoutDashes(name));
    // If all letters had to change, the names would not be similar.
    if (distance >= least || distance >= letters.size()) continue;
    least = distance;
    nearest = name;
  }
  return nearest;
}

}  // namespace loopgrid
