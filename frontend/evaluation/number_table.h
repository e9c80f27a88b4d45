#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "backend/base/error.h"

namespace loopgrid {

/// A text file with eight numbers a line, as trajectories and relations are.
struct NumberTable {
  static constexpr std::size_t kColumns = 8;

  struct Row {
    std::int64_t line_number = 0;  ///< in the file, from 1
    std::array<double, kColumns> numbers{};
  };

  std::string path = {};
  std::vector<Row> rows = {};

  /// An Error (kInput) about a row, beginning with `file:line: `.
  Error ErrorAt(const Row& row, const std::string& problem) const;
};

/// Reads the whole file, once, so that it may be a pipe. Passes over blank lines and comments
/// (`#`). Throws Error (kInput) `file:line: ...` for a line that is not eight finite numbers.
NumberTable ReadNumberTable(const std::string& path);

}  // namespace loopgrid
