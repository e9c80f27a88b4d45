#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "backend/base/input_file.h"
#include "backend/base/line_reader.h"

namespace loopgrid {

/// Reads the lines of a file with their line ends. All pieces together are the file, byte for byte.
class RawLineReader {
 public:
  explicit RawLineReader(InputFile file,
                         std::size_t longest_piece = LineReader::kMaxLineLength + 2);

  /// The next line with its end, if it has one; false at the end of the file. A long line comes in
  /// several pieces. `piece` is valid until the next call. Throws Error (kInput) if the file cannot
  /// be read further.
  bool Next(std::string_view* piece);

  /// Whether the last piece is a whole line with its end.
  bool whole() const { return begins_line_ && ends_line_; }

  /// Whether the last piece has the end of its line.
  bool ends_line() const { return ends_line_; }

  /// Number of the line that the last piece belongs to, from 1.
  std::int64_t line_number() const { return line_number_; }

 private:
  bool Refill();

  InputFile file_;
  std::size_t longest_piece_;
  std::string buffer_;
  std::size_t begin_ = 0;  // of what is read but not yet returned
  std::int64_t line_number_ = 0;
  bool begins_line_ = true;
  bool ends_line_ = true;
};

}  // namespace loopgrid
