#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "backend/base/error.h"
#include "backend/base/input_file.h"

namespace loopgrid {

/// The lines of a text file, plain or gzipped, in constant memory.
class LineReader {
 public:
  static constexpr std::size_t kMaxLineLength = std::size_t{1} << 20;

  /// Throws Error (kInput) as InputFile does.
  explicit LineReader(const std::string& path) : LineReader(InputFile(path)) {}
  explicit LineReader(InputFile file, std::size_t max_line_length = kMaxLineLength);

  /// The next line without its end (LF or CRLF), valid until the next call; false at the end of the
  /// file. Throws Error (kInput) if the file cannot be read further.
  bool Next(std::string_view* line);

  /// Whether the last line was longer than allowed. Next() has then returned an empty line for it.
  bool too_long() const { return too_long_; }

  /// Whether the last line ended with a line end. Otherwise it may have been cut off anywhere.
  bool terminated() const { return terminated_; }

  /// Number of the last line, from 1.
  std::int64_t line_number() const { return line_number_; }

  const std::string& path() const { return file_.path(); }
  double progress() const { return file_.progress(); }

  /// `file:line: `, the beginning of a message about the last line.
  std::string Where() const;

  /// An Error (kInput) about the last line.
  Error ErrorHere(const std::string& problem) const;

 private:
  bool Refill();
  const char* FindLineEnd(std::size_t searched) const;
  void SkipByteOrderMark(std::string_view* line) const;

  InputFile file_;
  std::size_t max_line_length_;
  std::unique_ptr<char[]> buffer_;
  std::size_t begin_ = 0;  // of what is read but not yet given out
  std::size_t end_ = 0;
  std::int64_t line_number_ = 0;
  bool too_long_ = false;
  bool terminated_ = true;
};

}  // namespace loopgrid
