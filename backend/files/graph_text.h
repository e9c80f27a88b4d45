#pragma once

#include <fmt/compile.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "backend/files/graph_file.h"

namespace loopgrid {

/// The names of nodes and landmarks in a file (see GraphIds).
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
    const auto position = static_cast<std::size_t>(index);
    if (ids_.landmarks.empty()) return static_cast<std::int64_t>(nodes_ + position);
    return ids_.landmarks[position];
  }

 private:
  std::size_t nodes_;
  const GraphIds& ids_;
};

/// Makes the text of a graph file line by line.
class GraphText {
 public:
  /// Begins a line.
  void Begin(std::string_view tag, std::initializer_list<std::int64_t> ids) {
    if (!text_.empty()) text_ += '\n';
    text_ += tag;
    for (std::int64_t id : ids) Id(id);
  }

  void Id(std::int64_t id) { Append(id); }

  /// With as many digits as it takes to read the same numbers again.
  template <typename Vector>
  void Numbers(const Vector& numbers) {
    for (double number : numbers) Append(number);
  }

  /// Row by row.
  template <typename Matrix>
  void UpperTriangle(const Matrix& matrix) {
    for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
      for (Eigen::Index column = row; column < matrix.cols(); ++column) Append(matrix(row, column));
    }
  }

  std::string Finish() && {
    if (!text_.empty()) text_ += '\n';
    return std::move(text_);
  }

 private:
  template <typename Number>
  void Append(Number number) {
    text_ += ' ';
    fmt::format_to(std::back_inserter(text_), FMT_COMPILE("{}"), number);
  }

  std::string text_;
};

}  // namespace loopgrid
