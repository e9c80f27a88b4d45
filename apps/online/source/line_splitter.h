#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "apps/online/source/line_queue.h"
#include "backend/base/line_reader.h"

namespace loopgrid {

/// Splits a stream that arrives in pieces into the same lines that LineReader finds in a file of
/// the same bytes. Takes constant memory: a line that is too long is skipped while it arrives.
class LineSplitter {
 public:
  explicit LineSplitter(std::size_t max_line_length = LineReader::kMaxLineLength)
      : max_line_length_(max_line_length) {}

  /// Removes bytes from the front of `bytes` until a line is complete. False if they end before
  /// that. Sets all of `line` but its arrival.
  bool Next(std::string_view* bytes, ReceivedLine* line);

  /// Call at the end of the stream: gives the rest of it, as a line that is not terminated. False
  /// if nothing is left. The next bytes begin a new stream.
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
