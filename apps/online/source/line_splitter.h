#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "apps/online/source/line_queue.h"
#include "backend/base/line_reader.h"

namespace loopgrid {

/// Splits a stream that arrives in pieces into the lines that LineReader would find in a file of
/// the same bytes, in constant memory: a line that is too long is skipped as it comes.
class LineSplitter {
 public:
  explicit LineSplitter(std::size_t max_line_length = LineReader::kMaxLineLength)
      : max_line_length_(max_line_length) {}

  /// Takes bytes off the front of `bytes` until a line is complete; false when they are used up
  /// before that. Sets all of `line` but its arrival.
  bool Next(std::string_view* bytes, ReceivedLine* line);

  /// At the end of the stream: what is left of it, as a line that is not terminated; false if
  /// nothing is. The next bytes begin a new stream.
  bool Finish(ReceivedLine* line);

 private:
  void Take(std::string_view bytes);
  void MakeLine(bool terminated, ReceivedLine* line);

  std::size_t max_line_length_;
  std::string begun_;      // of the line so far, if not too long
  bool skipping_ = false;  // the line is too long
  bool at_start_ = true;   // it is the stream's first one
};

}  // namespace loopgrid
