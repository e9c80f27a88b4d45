#include "apps/replay/raw_line_reader.h"

#include <algorithm>
#include <utility>

namespace loopgrid {

RawLineReader::RawLineReader(InputFile file, std::size_t longest_piece)
    : file_(std::move(file)), longest_piece_(longest_piece) {}

bool RawLineReader::Next(std::string_view* piece) {
  std::size_t searched = 0;  // bytes of the line known to hold no line end
  std::size_t end = buffer_.npos;
  while ((end = buffer_.find('\n', begin_ + searched)) == buffer_.npos) {
    searched = buffer_.size() - begin_;
    if (searched >= longest_piece_ || !Refill()) break;
  }
  const std::size_t available = end == buffer_.npos ? searched : end + 1 - begin_;
  if (available == 0) return false;
  *piece = std::string_view(buffer_).substr(begin_, std::min(available, longest_piece_));
  begin_ += piece->size();
  begins_line_ = ends_line_;
  ends_line_ = piece->ends_with('\n');
  if (begins_line_) ++line_number_;
  return true;
}

bool RawLineReader::Refill() {
  constexpr std::size_t kChunk = std::size_t{1} << 16;
  buffer_.erase(0, std::exchange(begin_, 0));
  const std::size_t had = buffer_.size();
  buffer_.resize(had + kChunk);
  std::size_t count = 0;
  try {
    count = file_.Read(buffer_.data() + had, kChunk);
  } catch (...) {
    buffer_.resize(had);
    throw;
  }
  buffer_.resize(had + count);
  return count > 0;
}

}  // namespace loopgrid
