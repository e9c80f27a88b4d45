#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "backend/graph_file.h"

namespace loopgrid {

/// What nodes and landmarks are called in a file (see GraphIds).
class GraphNames {
 public:
  GraphNames(std::size_t nodes, const GraphIds& ids) : nodes_(nodes), ids_(ids) {}

  template <typename Index>
  std::int64_t node(Index index) const {
    if (ids_.nodes.empty()) return static_cast<std::int64_t>(index);
    return ids_.nodes[static_cast<std::size_t>(index)];
  }
  template <typename Index>
  std::int64_t landmark(Index index) const {
    if (ids_.landmarks.empty())
      return static_cast<std::int64_t>(nodes_) + static_cast<std::int64_t>(index);
    return ids_.landmarks[static_cast<std::size_t>(index)];
  }

 private:
  std::size_t nodes_;
  const GraphIds& ids_;
};

/// The beginning of a line.
inline void AppendTag(std::string_view tag, std::initializer_list<std::int64_t> names,
                      std::string* text) {
  text->append(tag);
  for (std::int64_t name : names) fmt::format_to(std::back_inserter(*text), " {}", name);
}

/// With as many digits as it takes to read the same number again.
template <typename Numbers>
void AppendNumbers(const Numbers& numbers, std::string* text) {
  for (double number : numbers) fmt::format_to(std::back_inserter(*text), " {}", number);
}

/// Row by row.
template <typename Matrix>
void AppendUpperTriangle(const Matrix& matrix, std::string* text) {
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = row; column < matrix.cols(); ++column) {
      fmt::format_to(std::back_inserter(*text), " {}", matrix(row, column));
    }
  }
}

inline void AppendFixed(const std::vector<int>& fixed, const GraphNames& names, std::string* text) {
  for (int node : fixed) {
    AppendTag("FIX", {names.node(node)}, text);
    text->push_back('\n');
  }
}

}  // namespace loopgrid
